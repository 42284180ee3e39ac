"""PlanarSlip-v0."""

from __future__ import annotations

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS


class PlanarSlipEnv(SlipEnv):
    """Bring the object to a pose (x, y, theta) in the grip, by gravity, wrist and grip force.

    ## Description

    A parallel gripper holds a box at its centre of mass. The box is to be slid and turned between the pads
    until its slip displacement is a given (x, y, theta). Nothing but gravity moves it: the wrist's pitch
    decides where gravity pulls in the pad frame, the grip force how much of the pull friction leaves over.
    Friction is not known beforehand: an estimator works it out from force, torque and slip velocity.

    What can be reached follows from the limit surface. Let b be the pad centre's place on the box, from its
    centre of mass, and u the upward direction, both in the box's frame. Slipping slowly, the pads move on
    the box along u; the load is the weight, with the torque of its lever b x u, and the slip twist is normal
    to the ellipsoid there. So the box turns against the pads, per length of the slide, by (b x u) / r^2:

        d theta = (b x db) / r^2

    While b is 0 or along u, with the centre of mass straight under the pads (stable) or over them
    (unstable), the box slides without turning, whichever way the wrist points gravity. With the centre of
    mass to the side at a distance s it turns, and slides only r^2 / s per radian. Two motions in any order
    close this to no less than all of (x, y, theta); the target is drawn as the end of two: a slide by
    `slide` with the wrist pitched by `heading`, then a turn by `turn` about the pad centre. For r = 10 mm
    and s = 15 mm the pads would creep 6.7 mm per radian of the turn; hence the task's own contact, a rounded
    fingertip that touches with r = 5 mm (`tasks.planar_slip.radius`, the reset option `r`), which creeps by
    1.7 mm per radian. A contact smaller still holds less torque: with r = 5 mm a box of 0.2 kg
    18 mm off its centre of mass needs up to 12 N at a friction of 0.3.

    One step is one sample of the slip-velocity sensors, 1/120 s. The pad frame moves with the wrist: x and y
    span the contact plane (x horizontal and y up while the wrist is level), angles and torques count about
    the grip axis from finger 1 to finger 2. All units are SI.

    ## Action Space

    `Box(-1, 1, (2,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` (0.6 N)
    and +1 is `gripper.force_max` (25 N). Then the wrist's pitch rate, from -3 to 3 rad/s
    (`gripper.wrist_pitch_rate_max`). Values beyond are clipped; NaN and infinity are errors. The force
    follows with a dead time (4 ms) and a first-order lag (12 ms), the pitch rate within a sample.

    This is "grip_force_pitch", the `action_mode` of this task. Others add components, leave some out or
    change their meaning (see docs/modes.md): "grip_force" takes the grip force alone, "grip_force_wrist" the
    wrist's velocity along world x and z, too, "force_increment" the change of the grip force per sample.

    ## Observation Space

    `Box(low, high, (30,), float32)`. Forces, torques and velocities are measured, at the centre of pressure;
    index 24 to 29 are the friction part, which `friction_source="none"` leaves out (then the shape is (24,)).
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
    | 18 | `target_x`: slip displacement to reach, along the pads' x axis | -1 | 1 | m |
    | 19 | `target_y`: the same along the pads' y axis | -1 | 1 | m |
    | 20 | `target_theta`: the same about the grip axis | -10 | 10 | rad |
    | 21 | `time_left`: time until the episode ends | 0 | 1000 | s |
    | 22 | `wrist_pitch_rate`: commanded wrist pitch rate | -10 | 10 | rad/s |
    | 23 | `wrist_pitch`: pitch of the wrist against level | -10 | 10 | rad |
    | 24 | `mu_s`: static friction | 0 | 10 | - |
    | 25 | `mu_c`: Coulomb friction | 0 | 10 | - |
    | 26 | `r`: radius of the equivalent rim contact | 0 | 1 | m |
    | 27 | `support_mu_s`: how much data stands behind mu_s | 0 | 1 | - |
    | 28 | `support_mu_c`: how much data stands behind mu_c | 0 | 1 | - |
    | 29 | `support_r`: how much data stands behind r | 0 | 1 | - |

    With `friction_source="estimated"` the friction part merges both fingers' estimates by their support, and
    the support (0 to 1) says how much data stands behind each: do not trust a value before it has grown. With
    "true" and "nominal" every support is 1.

    The travel is the sum of slip velocities at the pad centre, in the pad frame; the target is where the
    point of the box that lay at the pad centre at the grasp is to go. In a turn that point is carried along:
    d(x, y) = d travel + d theta (-y, x).

    With "grip_force_wrist" the wrist's velocities come before its pitch rate; in modes that leave the wrist
    alone, index 22 and 23 are missing. `observation_mode="sensor"` leaves the friction part out; "dict"
    gives the groups "policy" (the above) and "privileged" (the truth); `history=k` puts the last k
    observations in front of each (see docs/modes.md).

    ## Rewards

    The sum of these terms, each times its scale (`tasks.planar_slip.reward`), per sample:

    | Term | Scale | Value before scaling |
    |---|---|---|
    | `position` | 1 | exp(-e^2), e = error in (x, y) / tolerance |
    | `angle` | 1 | exp(-a^2), a = error in theta / angle_tolerance |
    | `distance` | 0.1 | -(e + a) / 2, at least -10 |
    | `effort` | 0.1 | -(mean actuator force / gripper.force_max) |
    | `smoothness` | 0.1 | -(change of the commanded force / gripper.force_max)^2 |
    | `wrist` | 0.1 | -(commanded speed / its limit)^2 - (commanded pitch rate / its limit)^2 |
    | `drop` | 100 | -1 on a drop, else 0 |

    ## Starting State

    The box (`tasks.planar_slip.object`: 0.2 kg, 160 mm by 200 mm, gripped at its centre of mass) is held in
    a grip of `tasks.planar_slip.initial_force` (10 N), the wrist level. Drawn are the target (`slide` 10 to
    18 mm, `heading` up to 60 deg and `turn` 10 to 40 deg, both either way), the material, if `material` is
    "random", the sensors' biases and the fractions of a count that the slip sensors begin with. Grip and
    sensors run for six samples before time 0.

    ## Episode End

    - Terminated: the box is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
    - Truncated: `duration` has passed (12 s, 1440 samples). The environment truncates by itself; no
      `TimeLimit` is needed.

    Success (`info["is_success"]`): the episode was played to its end, the box was not dropped, and at the end
    its slip displacement is within `tolerance` (2 mm) of the target in (x, y) and within `angle_tolerance`
    (3 deg) in theta, at rest: no point of the pads slips faster than `rest_speed` (1 mm/s).

    ## Arguments

    | Argument | Default | Meaning |
    |---|---|---|
    | `friction_source` | `"estimated"` | friction in the observation: or `"true"`, `"nominal"`, `"none"` |
    | `estimator` | `"disc"` | a name of `estimator.names()`, or a mapping with its `name` and parameters |
    | `contact` | `"ellipsoid"` | friction model of the pads: or `"distributed"` (see `contact.pressure`) |
    | `sensors` | `"realistic"` | sensor preset: `"realistic"` or `"ideal"` |
    | `material` | `"random"` | name of a material, or `"random"` for another in every episode |
    | `action_mode` | `None` | what an action means, see Action Space; `None`: `"grip_force_pitch"` |
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
    | `slide` | Length of the target's slide [m] |
    | `heading` | Pitch of the wrist during that slide [rad] |
    | `turn` | Angle of the target's turn [rad] |
    | `duration` | Length of the episode [s] |
    | `tolerance` | Largest final error in (x, y) for success [m] |
    | `angle_tolerance` | Largest final error in theta for success [rad] |

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
    | `reference` | the target (x, y, theta), (3,) [m, m, rad] |
    | `reward_terms` | scaled reward terms of this step by name; they add up to the reward |
    | `time` | time since reset [s] |
    | `is_success` | whether the task is solved; see Episode End |
    | `dropped` | whether the box is dropped |

    With a randomization, the info of a reset also holds `drawn`: what was drawn for the episode, by name (see
    docs/randomization.md).

    ## Version History

    - v0: first version.
    """

    task = TASKS["PlanarSlip"]
