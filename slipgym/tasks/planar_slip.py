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

The travel is the sum of slip velocities at the pad centre, in the pad frame; the target is where the
point of the box that lay at the pad centre at the grasp is to go. In a turn that point is carried along:
d(x, y) = d travel + d theta (-y, x).

## Action Space

`Box(-1, 1, (2,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` (0.6 N)
and +1 is `gripper.force_max` (25 N). Then the wrist's pitch rate, from -3 to 3 rad/s
(`gripper.wrist_pitch_rate_max`). Values beyond are clipped; NaN and infinity are errors. The force
follows with a dead time (4 ms) and a first-order lag (12 ms), the pitch rate within a sample.

This is "grip_force_pitch", the `action_mode` of this task. Others add components, leave some out or
change their meaning (see docs/modes.md): "grip_force" takes the grip force alone, "grip_force_wrist" the
wrist's velocity along world x and z, too, "force_increment" the change of the grip force per sample.

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

## Info

| `reference` | the target (x, y, theta), (3,) [m, m, rad] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math

import numpy as np
from pydantic import Field

from slipgym._numba.compiled import compiled
from slipgym.config import Config, TaskConfig
from slipgym.config.base import NonNegative, Positive, PositiveInterval
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, roughness
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import DROP, EFFORT, SMOOTHNESS, Column, Task, Term


class Settings(TaskConfig):
    """The object is moved in the grip to a given pose (x, y, theta)."""

    slide: PositiveInterval = Field(description="The target's slide is drawn from this range [m]")
    heading: NonNegative = Field(description="Largest pitch of the wrist during the target's slide [rad]")
    turn: PositiveInterval = Field(
        description="The target's turn, either way, is drawn from this range [rad]"
    )
    duration: Positive = Field(description="Length of an episode [s]")
    tolerance: Positive = Field(description="Largest final error in (x, y) for success [m]")
    angle_tolerance: Positive = Field(description="Largest final error in theta for success [rad]")
    rest_speed: Positive = Field(description="Largest final slip speed at the pad's rim for success [m/s]")


DEFAULTS = {
    "slide": [0.010, 0.018],
    "heading": 1.0472,  # 60 degrees
    "turn": [0.1745, 0.6981],  # 10 to 40 degrees
    "duration": 12.0,
    "tolerance": 0.002,
    "angle_tolerance": 0.0524,  # 3 degrees
    "rest_speed": 0.001,
    "initial_force": 10.0,
    "object": {  # large and flat, gripped at its centre of mass
        "mass": 0.2,
        "size": [0.16, 0.03, 0.2],
        "com_offset": [0.0, 0.0],
        "inertia": None,
        "grasp_offset": [0.0, 0.0],
    },
    "radius": 0.005,  # a rounded fingertip: see docs/environments/planar_slip.md
}
REWARD = (
    Term("position", 1.0, "exp(-e^2), e = error in (x, y) / tolerance"),
    Term("angle", 1.0, "exp(-a^2), a = error in theta / angle_tolerance"),
    Term("distance", 0.1, "-(e + a) / 2, at least -10"),
    Term("effort", 0.1, EFFORT),
    Term("smoothness", 0.1, SMOOTHNESS),
    Term("wrist", 0.1, "-(commanded speed / its limit)^2 - (commanded pitch rate / its limit)^2"),
    Term("drop", 100.0, DROP),
)
TARGET, ANGLE_TOLERANCE, REST_SPEED = slice(0, 3), 3, 4
"""Places in the episode's own numbers: slip displacement to reach [m, m, rad], angle [rad], speed [m/s]."""
COLUMNS = (
    Column("target_x", -1.0, 1.0, "m", "slip displacement to reach, along the pads' x axis"),
    Column("target_y", -1.0, 1.0, "m", "the same along the pads' y axis"),
    Column("target_theta", -10.0, 10.0, "rad", "the same about the grip axis"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    slide: Positive | None = Field(default=None, le=0.1, description="Length of the target's slide [m]")
    heading: float | None = Field(
        default=None, ge=-1.6, le=1.6, description="Pitch of the wrist during that slide [rad]"
    )
    turn: float | None = Field(default=None, ge=-1.6, le=1.6, description="Angle of the target's turn [rad]")
    duration: Positive | None = Field(default=None, le=120.0, description="Length of the episode [s]")
    tolerance: Positive | None = Field(
        default=None, description="Largest final error in (x, y) for success [m]"
    )
    angle_tolerance: Positive | None = Field(
        default=None, description="Largest final error in theta for success [rad]"
    )


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the target is the end of a plan that is drawn: slide, then turn."""
    task = config.tasks.planar_slip
    # drawn always, so that options do not shift later draws
    drawn = {
        "slide": rng.uniform(*task.slide),
        "heading": rng.uniform(-task.heading, task.heading),
        "turn": rng.uniform(*task.turn) * (-1, 1)[rng.integers(2)],
    }
    plan = {name: getattr(options, name) for name in drawn}
    slide, heading, turn = (drawn[name] if plan[name] is None else plan[name] for name in drawn)
    episode["own"][TARGET] = hang(slide, heading, turn)
    episode["tolerance"] = options.choose("tolerance", task)
    episode["own"][ANGLE_TOLERANCE] = options.choose("angle_tolerance", task)
    episode["own"][REST_SPEED] = task.rest_speed
    episode["steps"] = max(1, round(options.choose("duration", task) / episode["step_time"]))


def hang(slide: float, heading: float, turn: float) -> tuple[float, float, float]:
    """Slip displacement after a slide along gravity and a turn about the pad centre.

    Args:
        slide: Length of the slide [m].
        heading: Pitch of the wrist during it [rad].
        turn: Angle by which the object then turns in the grip [rad].

    Returns:
        (x, y, theta) [m, m, rad]; the slide by `turn` turned about the pad centre.
    """
    down = heading - turn
    return -slide * math.sin(down), -slide * math.cos(down), turn


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist moves as the agent commands."""
    for i in range(episodes.shape[0]):
        drive_wrist(episodes[i], worlds[i], 0.0, 0.0, 0.0)


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: distance to the target, reward terms, outcome, observation.

    Args:
        episodes: EPISODE (n,).
        worlds: WORLD (n,).
        fingers: FINGER (n, 2).
        columns: Output (n, 4), see `COLUMNS`.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        own, slip, twist, wrist = episode.own, world.slip, world.slip_twist, episode.wrist_command
        target = own[TARGET]
        for k in range(3):
            episode.reference[k] = columns[i, k] = target[k]
        columns[i, 3] = (episode.steps - episode.step) * episode.step_time
        away = math.hypot(slip[0] - target[0], slip[1] - target[1]) / episode.tolerance
        askew = abs(slip[2] - target[2]) / own[ANGLE_TOLERANCE]
        speed = math.hypot(math.hypot(twist[0], twist[1]), episode.pad_radius * twist[2])
        episode.dropped = detect_drop(episode, world, fingers[i])
        episode.success = (
            episode.step >= episode.steps
            and not episode.dropped
            and away <= 1.0
            and askew <= 1.0
            and speed <= own[REST_SPEED]
        )
        moved = math.hypot(wrist[0], wrist[1]) / episode.wrist_speed_max
        pitched = wrist[2] / episode.wrist_pitch_rate_max
        terms = (
            math.exp(-(away**2)),
            math.exp(-(askew**2)),
            -min(0.5 * (away + askew), 10.0),
            -effort(episode, fingers[i]),
            -roughness(episode),
            -(moved**2 + pitched**2),
            -1.0 if episode.dropped else 0.0,
        )
        for k in range(7):
            episode.terms[k] = episode.scales[k] * terms[k]


TASK = Task(
    id="slipgym/PlanarSlip-v0",
    key="planar_slip",
    settings=Settings,
    defaults=DEFAULTS,
    options=Options,
    reward=REWARD,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    action_mode="grip_force_pitch",
    motion=Motion("turned in the grip", "rad", (0.0, 0.0, 1.0), entry=2, goal="target_theta"),
    page=__doc__,
)
