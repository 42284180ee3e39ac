"""Hinge-v0."""

from __future__ import annotations

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS


class HingeEnv(SlipEnv):
    """Let the object hang upright while the wrist pitches, without sliding.

    ## Description

    A parallel gripper holds a box near its top. The wrist pitches along a trapezoidal profile, and the grip
    must be so loose that the box stays upright, turning between the pads like a door on a hinge, and so
    firm that it does not slide down. Friction is not known beforehand: an estimator works it out from
    force, torque and slip velocity while the box turns. After the hinge of Waltersson and Karayiannidis
    (arXiv 2410.19660), who pitch from 60 to 120 deg; only the relative turn matters to round pads.

    Sliding and tilt are bound to each other. While the box turns in the grip, the slip twist is normal to
    the limit surface at the load: it slides r^2 / (d sin(tilt)) per radian, d being the depth of its centre
    of mass below the pads. For a pad with r = 10 mm, d = 100 mm and a tilt of 5 deg that is 11 mm per
    radian, whatever the controller does. Hence the task's own contact: a rounded fingertip that touches
    with r = 3 mm (`tasks.hinge.radius`, the reset option `r`). Then f_n mu_c / f_t has to lie between about
    1.9, for 2 mm in a turn of 60 deg, and 3.1, for 5 deg. Static friction, 1.4 to 1.6 times larger, makes
    the start the hard part: a grip in that range would take the box along by more than 5 deg before it lets
    go.

    One step is one sample of the slip-velocity sensors, 1/120 s. The pad frame moves with the wrist: x and y
    span the contact plane (x horizontal and y up while the wrist is level), angles and torques count about
    the grip axis from finger 1 to finger 2. All units are SI.

    ## Action Space

    `Box(-1, 1, (1,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` (0.6 N)
    and +1 is `gripper.force_max` (25 N). Values beyond are clipped; NaN and infinity are errors. The force
    follows with a dead time (4 ms) and a first-order lag (12 ms).

    Other values of `action_mode` add components or change their meaning (see docs/modes.md):
    "grip_force_pitch" adds the wrist's pitch rate, "grip_force_wrist" its velocity along world x and z and
    its pitch rate, "force_increment" takes the change of the grip force per sample instead.

    ## Observation Space

    `Box(low, high, (29,), float32)`. Forces, torques and velocities are measured, at the centre of pressure;
    index 23 to 28 are the friction part, which `friction_source="none"` leaves out (then the shape is (23,)).
    Bounds follow the configuration; those of the defaults are

    | Index | Observation | Min | Max | Unit |
    |---|---|---|---|---|
    | 0 | `f_x_1`: tangential force on finger 1 | -80 | 80 | N |
    | 1 | `f_y_1`: tangential force on finger 1 | -80 | 80 | N |
    | 2 | `f_n_1`: normal force of finger 1 | -240 | 240 | N |
    | 3 | `tau_1`: torque at finger 1's CoP | -4 | 4 | N m |
    | 4 | `v_x_1`: slip velocity at finger 1's CoP | -2 | 2 | m/s |
    | 5 | `v_y_1`: slip velocity at finger 1's CoP | -2 | 2 | m/s |
    | 6 | `omega_1`: slip rate about the grip axis at finger 1 | -82.3 | 82.3 | rad/s |
    | 7 | `f_x_2`: tangential force on finger 2 | -80 | 80 | N |
    | 8 | `f_y_2`: tangential force on finger 2 | -80 | 80 | N |
    | 9 | `f_n_2`: normal force of finger 2 | -240 | 240 | N |
    | 10 | `tau_2`: torque at finger 2's CoP | -4 | 4 | N m |
    | 11 | `v_x_2`: slip velocity at finger 2's CoP | -2 | 2 | m/s |
    | 12 | `v_y_2`: slip velocity at finger 2's CoP | -2 | 2 | m/s |
    | 13 | `omega_2`: slip rate about the grip axis at finger 2 | -82.3 | 82.3 | rad/s |
    | 14 | `travel_x`: slip displacement, summed from the counts of both fingers | -1 | 1 | m |
    | 15 | `travel_y`: the same along the pads' y axis | -1 | 1 | m |
    | 16 | `travel_theta`: the same about the grip axis | -10 | 10 | rad |
    | 17 | `command`: grip force commanded in the last step | 0 | 40 | N |
    | 18 | `wrist_pitch`: pitch of the wrist since the start | -10 | 10 | rad |
    | 19 | `wrist_pitch_rate`: its rate | -10 | 10 | rad/s |
    | 20 | `wrist_pitch_acceleration`: its second rate | -100 | 100 | rad/s^2 |
    | 21 | `wrist_pitch_goal`: pitch at the end of the turn | -10 | 10 | rad |
    | 22 | `time_left`: time until the episode ends | 0 | 1000 | s |
    | 23 | `mu_s`: static friction | 0 | 10 | - |
    | 24 | `mu_c`: Coulomb friction | 0 | 10 | - |
    | 25 | `r`: radius of the equivalent rim contact | 0 | 1 | m |
    | 26 | `support_mu_s`: how much data stands behind mu_s | 0 | 1 | - |
    | 27 | `support_mu_c`: how much data stands behind mu_c | 0 | 1 | - |
    | 28 | `support_r`: how much data stands behind r | 0 | 1 | - |

    With `friction_source="estimated"` the friction part merges both fingers' estimates by their support, and
    the support (0 to 1) says how much data stands behind each: do not trust a value before it has grown. With
    "true" and "nominal" every support is 1.

    With an `action_mode` that moves the wrist, what the agent commands of it and its pitch precede
    the friction part, unless the table has them. `observation_mode="sensor"` leaves the friction part out;
    "dict" gives the groups "policy" (the above) and "privileged" (the truth); `history=k` puts the last k
    observations in front of each (see docs/modes.md).

    ## Rewards

    The sum of these terms, each times its scale (`tasks.hinge.reward` in the configuration), per sample:

    | Term | Scale | Value before scaling |
    |---|---|---|
    | `still` | 1 | exp(-(s / slide_tolerance)^2), s = slip at the pad centre |
    | `upright` | 1 | exp(-(tilt / tilt_tolerance)^2), tilt = turn of the box since reset or, if larger, e |
    | `effort` | 0.1 | -(mean actuator force / gripper.force_max) |
    | `smoothness` | 0.1 | -(change of the commanded force / gripper.force_max)^2 |
    | `drop` | 100 | -1 on a drop, else 0 |

    e is how far the wrist's pitch is from its profile: 0, unless the agent moves the wrist. It counts as
    tilt, for success too, so that an agent cannot just undo the turn.

    ## Starting State

    The box (`tasks.hinge.object`: 0.2 kg, 50 mm by 250 mm, gripped 100 mm above its centre) hangs still in
    a grip of `tasks.hinge.initial_force` (5 N), the wrist level. The direction of the turn is drawn; so are
    the material, if `material` is "random", the sensors' biases and the fractions of a count that the slip
    sensors begin with. Grip and sensors run for six samples before time 0. The wrist rests for `settle`
    (0.5 s), pitches by `turn` (60 deg) in `duration` (5 s), and rests for `hold` (1 s).

    ## Episode End

    - Terminated: the box is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
    - Truncated: settle + duration + hold have passed (6.5 s, 780 samples). The environment truncates by
      itself; no `TimeLimit` is needed.

    Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never
    slid further than `slide_tolerance` (2 mm) at the pad centre and never tilted by more than
    `tilt_tolerance` (5 deg).

    ## Arguments

    | Argument | Default | Meaning |
    |---|---|---|
    | `friction_source` | `"estimated"` | friction in the observation: or `"true"`, `"nominal"`, `"none"` |
    | `estimator` | `"disc"` | a name of `estimator.names()`, or a mapping with its `name` and parameters |
    | `contact` | `"ellipsoid"` | friction model of the pads: or `"distributed"` (see `contact.pressure`) |
    | `sensors` | `"realistic"` | sensor preset: `"realistic"` or `"ideal"` |
    | `material` | `"random"` | name of a material, or `"random"` for another in every episode |
    | `action_mode` | `None` | what an action means, see Action Space; `None`: `"grip_force"` |
    | `observation_mode` | `"flat"` | how an observation is laid out: or `"sensor"`, `"dict"` |
    | `history` | `0` | how many earlier observations come along with each |
    | `randomization` | `"none"` | what else is drawn: `"train"`, `"eval_ood"`, a file or a mapping |
    | `frame_skip` | `1` | slip-velocity samples per step; the action is repeated, the rewards are summed |
    | `render_mode` | `None` | `None`, `"rgb_array"`: 720 by 480 pictures, `"depth_array"`, `"human"` |
    | `config` | `None` | file or mapping of overrides, merged over the defaults in `configs/` |

    ## Reset Options

    What `reset(options={...})` fixes for one episode; anything else in it is an error.

    | Option | Meaning |
    |---|---|
    | `material` | Name of a material, or "random" [-] |
    | `mu_s` | Static friction, >= mu_c [-] |
    | `mu_c` | Coulomb friction [-] |
    | `r` | Radius of the equivalent rim contact [m] |
    | `object_mass` | Mass of the object [kg] |
    | `object_size` | Extent along x, the grip axis and z [m] |
    | `com_offset` | Centre of mass (x, z) from the geometric centre [m] |
    | `initial_force` | Force per finger at reset [N] |
    | `randomization_scale` | Share of the randomization's ranges: 0 none, 1 all [-] |
    | `turn` | Angle by which the wrist pitches [rad] |
    | `direction` | Its sign, 1 or -1 [-] |
    | `duration` | Time for the turn [s] |
    | `settle` | Time held before the turn [s] |
    | `hold` | Time held after the turn [s] |
    | `slide_tolerance` | Largest slip for success [m] |
    | `tilt_tolerance` | Largest tilt for success [rad] |

    ## Info

    | Key | Content |
    |---|---|
    | `true` | true (mu_s, mu_c, r) now, (3,) [-, -, m] |
    | `estimated` | the estimators' (mu_s, mu_c, r), mean of both fingers, (3,) |
    | `estimated_per_finger` | the same, finger by finger, (2, 3) |
    | `slip` | true slip displacement (x, y, theta) in the pad frame since the grasp, (3,) [m, m, rad] |
    | `slip_twist` | true slip velocity (v_x, v_y, omega) at the pad centre, (3,) [m/s, m/s, rad/s] |
    | `contact_wrench` | true friction (f_x, f_y, tau) of either pad on the box, (2, 3) [N, N, N m] |
    | `grip_force` | actuator force of each finger, (2,) [N] |
    | `reference` | pitch of the wrist, its rate and acceleration, (3,) [rad, rad/s, rad/s^2] |
    | `reward_terms` | scaled reward terms of this step by name; they add up to the reward |
    | `time` | time since reset [s] |
    | `is_success` | whether the task is solved; see Episode End |
    | `dropped` | whether the box is dropped |

    With a randomization, the info of a reset also holds `drawn`: what was drawn for the episode, by name (see
    docs/randomization.md).

    ## Version History

    - v0: first version.
    """

    task = TASKS["Hinge"]
