"""Find out the friction of an object by letting it slip as little as possible.

## Description

A parallel gripper holds a box of unknown mass, friction and contact radius. The agent finds out mu_s, mu_c
and r, to `accuracy` (5 %) each, as fast as it can, and it may let the box slip by 2 mm and 5 degrees
meanwhile. Its action includes a guess: the logarithms of mu_s, mu_c and r and of their relative standard
deviations. It commits itself by stating deviations of at most `commitment` (2.5 %) for all three, which ends
the episode.

mu_c is drawn from 0.2 to 0.8, log-uniformly, mu_s / mu_c is the material's, and r is drawn from 6 to 10 mm
(`tasks.explore.friction_range`, `tasks.explore.radius_range`; assumed). mu_s shows when a slip begins, mu_c
in any slip, and r where the box slides and turns: the weight makes it slide, and a turn of the wrist makes it
turn, since its inertia holds it back.

## Action Space

`Box(-1, 1, (10,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` (0.6 N) and
+1 is `gripper.force_max` (25 N). Then the wrist's velocity along world x and z and its pitch rate, from -0.5
to 0.5 m/s (`gripper.wrist_speed_max`) and from -3 to 3 rad/s (`gripper.wrist_pitch_rate_max`).

Then the guess: ln mu_s, ln mu_c, ln r, and the logarithms of their relative standard deviations, in the
ranges of docs/modes.md. The actuator force follows with a dead time (4 ms) and a first-order lag (12 ms), the
wrist within a control step.

This is "grip_force_wrist_guess", the `action_mode` of this task. In the other modes (see docs/modes.md)
there is no guess, and the estimator's merged estimate and its deviations take its place.

## Rewards

S is the log score of the guess: the mean of -ln s - (e / s)^2 / 2 over mu_s, mu_c and r, with e = ln(guess /
truth) and the stated deviation s. An agent that states the deviations that it has reaches the highest
expected score. `score` and `time` are at most 0, so that an agent gains nothing by waiting.

The regret is that of a task that follows, in which the box is held at rest: its grip is 1.1 L(r) / mu_s by
the guess, with the load L(r) = sqrt(f_t^2 + (tau / r)^2) of the weight. The regret is this grip over the
least one, L(r) / mu_s by the truth, less 1; where the grip is below the least one the box slips, and the
regret is 1. Without an error it is 0.1.

## Starting State

The box (0.15 to 0.3 kg) hangs at rest in a grip of `tasks.explore.initial_force` (20 N), its centre of mass
between the pads. Sampled at random are its mass, friction and r. The wrist moves as the agent commands.

## Episode End

- Terminated: the box is dropped; or the agent commits itself: the three deviations of its guess are at most
  `commitment`.
- Truncated: `duration` has passed (3 s, 360 control steps).

Success (`info["is_success"]`): the episode has ended without a drop, mu_s, mu_c and r of the guess are
within `accuracy` of the truth, and the budget of slip was kept: the path of the slip at the pad centre is at
most `slide_tolerance` (2 mm), the path of the turn in the grip at most `tilt_tolerance` (5 deg). The paths
add up, so that slipping back gains nothing. Using up the budget is the violation that `violated` reports.
The truth is the mean of both pads, with jumps and drifts of the randomization, at the normal force at which
the values hold on soft pads.

## Info

| `reference` | log score S, regret, and share of the budget of slip that is used, (3,) [-, -, -] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.base import Positive
from slipgym.config.task import FrictionRange, InitialForce, MassRange, RadiusRange, TaskConfig, setting
from slipgym.tasks.disturbance import friction_factor
from slipgym.tasks.episode import scratch
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Task, event, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED
from slipgym.world.object_motion import wrench_at_rest

SCRATCH = scratch(last=3, slid=1, turned=1, lever=1, commitment=1)
"""`last`: slip displacement after the last control step (x, y, theta) [m, m, rad]; `slid`, `turned`: paths of
the slip so far [m, rad]; `lever`: torque over force of the weight [m]; `commitment`: relative deviation that
ends the episode [-]."""
MARGIN = 1.1
"""Grip of the task that follows over the least by the guess."""
SHARPEST = math.log(100.0)
"""Largest log score of a guess: that of 1 % without an error."""


class Settings(TaskConfig):
    """Settings of the exploration: friction is to be found within a budget of slip."""

    duration: Annotated[Positive, setting("Length of an episode", "s", reset=True, le=600.0)] = 3.0
    accuracy: Annotated[
        Positive, setting("Largest relative error of mu_s, mu_c and r for success", "-", reset=True)
    ] = 0.05
    commitment: Annotated[
        Positive,
        setting("Stated relative deviation of mu_s, mu_c and r that ends the episode", "-", reset=True),
    ] = 0.025
    slide_tolerance: Annotated[
        Positive, setting("Longest path of the slip at the pad centre for success", "m", reset=True)
    ] = 0.002
    tilt_tolerance: Annotated[
        Positive, setting("Longest path of the turn in the grip for success", "rad", reset=True)
    ] = 0.0873
    initial_force: InitialForce = 20.0
    mass_range: MassRange = (0.15, 0.3)
    friction_range: FrictionRange = (0.2, 0.8)
    radius_range: RadiusRange = (0.006, 0.01)


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row."""
    episode["tolerance"], episode["own"][SCRATCH.commitment] = settings.accuracy, settings.commitment
    episode["slide_tolerance"], episode["tilt_tolerance"] = settings.slide_tolerance, settings.tilt_tolerance
    episode["steps"] = max(1, round(settings.duration / episode["step_time"].item()))


def track(episode, world, fingers):
    """Add up the paths of the slip; write log score, regret and the used share of the budget."""
    own, slip = episode.own, world.slip
    if episode.step == 0:
        f_x, f_y, tau = wrench_at_rest(world)
        own[SCRATCH.lever] = tau / math.hypot(f_x, f_y)
    x, y, theta = own[SCRATCH.last]
    own[SCRATCH.slid] += math.hypot(slip[0] - x, slip[1] - y)
    own[SCRATCH.turned] += abs(slip[2] - theta)
    own[SCRATCH.last] = slip
    episode.reference[0] = log_score(episode, world)
    episode.reference[1] = regret(episode, world)
    used = own[SCRATCH.slid] / episode.slide_tolerance
    episode.reference[2] = max(used, own[SCRATCH.turned] / episode.tilt_tolerance)


@compiled
def truth(episode, world):
    """mu_s, mu_c [-] and r [m] now, means of both pads."""
    factor = 0.5 * (episode.finger_friction[0] + episode.finger_friction[1])
    factor *= friction_factor(episode, world)
    return factor * episode.mu_s, factor * episode.mu_c, episode.r


@compiled
def log_score(episode, world):
    """Log score S of the guess, see Rewards."""
    true, total = truth(episode, world), 0.0
    for k in range(3):
        deviation = max(episode.guess[3 + k], 1e-3)
        error = math.log(max(episode.guess[k], 1e-6) / max(true[k], 1e-6))
        total -= math.log(deviation) + 0.5 * (error / deviation) ** 2
    return total / 3.0


@compiled
def regret(episode, world):
    """Grip of the task that follows over the least, less 1; 1 if the object then slips, see Rewards [-]."""
    (mu_s, _, r), lever = truth(episode, world), episode.own[SCRATCH.lever]
    least = math.hypot(1.0, lever / r) / mu_s
    grip = math.hypot(1.0, lever / max(episode.guess[2], 1e-6)) / max(episode.guess[0], 1e-6)
    excess = MARGIN * grip / least - 1.0
    return excess if excess >= 0.0 else 1.0


def ends(episode, world):
    """Whether all three stated deviations are small enough."""
    return episode.step > 0 and episode.guess[3:].max() <= episode.own[SCRATCH.commitment]


def violated(episode, world, fingers):
    """Whether the budget of slip is used up."""
    return episode.reference[2] > 1.0


def success(episode, world):
    """Whether all three guesses are close to the truth."""
    true, worst = truth(episode, world), 0.0
    for k in range(3):
        worst = max(worst, abs(episode.guess[k] / true[k] - 1.0))
    return worst <= episode.tolerance


@term(scale=0.5)
def score(episode, world, fingers):
    """(S / ln 100 - 1) / 2, S = log score of the guess, ln 100 that of 1 % without an error."""
    return 0.5 * (episode.reference[0] / SHARPEST - 1.0)


@term(scale=0.3)
def time(episode, world, fingers):
    """-1 until the episode ends."""
    return -1.0


@term(scale=0.2)
def slip(episode, world, fingers):
    """-(share of the budget of slip that is used)."""
    return -episode.reference[2]


@event(scale=0.5)
def following(episode, world, fingers):
    """-min(regret, 1) at the end of the episode."""
    over = episode.ended or (episode.step >= episode.steps and not episode.dropped)
    return -min(episode.reference[1], 1.0) if over else 0.0


TASK = Task(
    id="slipgym/Explore-v0",
    settings=Settings,
    start=start,
    track=track,
    ends=ends,
    violated=violated,
    success=success,
    terms=(score, time, slip, following, *OUTCOME),
    columns=(TIME_LEFT, VIOLATED),
    action_mode="grip_force_wrist_guess",
    motion=Motion(sign=0.0),
    page=__doc__,
)
