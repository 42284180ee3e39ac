"""Motion by leaps: the object breaks away, slips a little, is caught, and rests until it has been measured.

The slip velocity arrives late, and by how much nobody knows. The tangential force does not: when the object
breaks away, friction carries less than its load, and the force falls at once. So a leap begins when the force
falls and ends after a planned time; the late velocity only says afterwards how long the leap was. The grip at
which the object broke away, over the load, is where the next break-away is looked for. That follows friction
which changes, without an estimate.

**Slides.** The object falls at the grip at which it broke away. The length of a leap grows with the square of
its time, `reach` (n + 1.5)^2 for n control steps; `reach` is learned from the leaps that were measured.

**Turns.** A box that is let go falls and does not turn: while friction carries its weight and part of the
torque, it turns. So a turn lasts `turn_steps` at a grip closer to balance, `brake` times that of the
break-away, and `brake` is adjusted until a leap is as long as wanted.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from policies.controllers.gains import Gain
from slipgym.config.base import Frozen, NonNegative, Positive

BEGUN = 1.5
"""Control steps that a leap lasts beyond those it is given: until it is noticed, and until it is caught."""
RATE = 120.0
"""Control rate at which the gains that count control steps are given [Hz]."""
LEAST_LOAD = 1.0
"""Load below which the fall that marks a break-away does not get smaller [N]."""


class LeapState(NamedTuple):
    """Memory of the leaps, arrays (n,)."""

    load: np.ndarray  # smoothed load per finger while the object rests [N]
    last: np.ndarray  # load at the last control step [N]
    noise: np.ndarray  # standard deviation of the measured load [N]
    ratio: np.ndarray  # grip over load at which the object is about to break away [-]
    clock: np.ndarray  # control steps that a leap has run, minus those of rest left; 0: the grip falls
    steps: np.ndarray  # control steps that the present leap is given
    left: np.ndarray  # distance left when the last leap had been measured [m or rad]
    reach: np.ndarray  # length of a slide over the squared number of its control steps [m]
    brake: np.ndarray  # grip in a turn over that of the break-away [-]


class LeapGains(Frozen):
    """Gains of the leaps; numbers of control steps are at 120 Hz (`at_rate`)."""

    start: Positive = Gain(1.3, "Grip from which it falls to the first break-away, over f_slip [-]")
    keep: Positive = Gain(0.96, "Fraction of the grip left a control step later [-]", lt=1)
    again: Positive = Gain(1.12, "Ratio of the grip after a leap to the grip at the break-away [-]")
    fall: Positive = Gain(0.1, "Fall of the load that is a break-away [-]")
    deviations: NonNegative = Gain(2.5, "And over the noise of the load, at least [-]")
    quiet: NonNegative = Gain(0.05, "Largest noise allowed for, over the load [-]")
    speed: Positive = Gain(0.012, "Scaled slip speed that is a break-away [m/s]")
    slide: Positive = Gain(0.0012, "Longest leap of a slide [m]")
    turn: Positive = Gain(0.02, "Longest leap of a turn [rad]")
    share: Positive = Gain(0.6, "Length of a leap over the distance left, at most [-]")
    reach: Positive = Gain(1.5e-4, "Length of a slide over squared steps, at first [m]")
    slide_steps: int = Gain(5, "Control steps of a slide, at most [-]", ge=0)
    turn_steps: int = Gain(8, "Control steps of a turn [-]", ge=0)
    learn: NonNegative = Gain(0.1, "Exponent with which the grip of a turn adapts [-]")
    rest: int = Gain(9, "Control steps of rest after a leap; cover the latency of the sensor [-]", ge=1)
    firm: int = Gain(3, "The first of them, in which the grip is doubled [-]", ge=0)


def at_rate(gains: LeapGains, rate: float) -> LeapGains:
    """Gains for another control rate [Hz]: the same times in its control steps, at least one of rest."""
    longer = RATE / rate
    return gains.model_copy(
        update={
            "keep": gains.keep**longer,
            "reach": gains.reach * longer**2,
            "slide_steps": round(gains.slide_steps / longer),
            "turn_steps": round(gains.turn_steps / longer),
            "rest": math.ceil(gains.rest / longer),
            "firm": math.ceil(gains.firm / longer),
        }
    )


class Slip(NamedTuple):
    """Request to the leaps, arrays (n,)."""

    wanted: np.ndarray  # whether the object is to slip
    begins: np.ndarray  # whether that is new
    turning: np.ndarray  # whether it is to turn; else it is to slide
    distance: np.ndarray  # distance left [m or rad]
    load: np.ndarray  # measured load per finger, scaled as on the limit surface [N]
    speed: np.ndarray  # measured scaled slip speed [m/s]
    f_slip: np.ndarray  # grip over load that balances at the Coulomb friction of the observation [-]
    held: np.ndarray  # grip that holds the object [N]


def begin(n: int, gains: LeapGains) -> LeapState:
    """Memory of n rows before their first leap."""
    zero = np.zeros(n)
    first = {"reach": np.full(n, gains.reach), "brake": np.full(n, gains.start)}
    return LeapState(**dict.fromkeys(LeapState._fields, zero) | first)


def leap(state: LeapState, slip: Slip, gains: LeapGains, force_max: float) -> tuple[np.ndarray, LeapState]:
    """One control step of the leaps, and of holding where no slip is wanted.

    Args:
        state: Memory of n rows.
        slip: What is wanted and measured.
        gains: The gains.
        force_max: Largest command [N].

    Returns:
        Grip per finger (n,) [N], and the new memory.
    """
    ratio = np.where(slip.begins, gains.start * slip.f_slip, state.ratio)
    load = np.where(slip.begins | (state.load == 0.0), slip.load, state.load)
    falls, rests, measured = slip.wanted & (state.clock == 0.0), state.clock < 0.0, state.clock == -1.0
    lost = (load - slip.load > break_away(load, state.noise, gains)) | (slip.speed > gains.speed)
    breaks = falls & lost
    runs = (state.clock > 0.0) | breaks
    steps = np.where(breaks, _steps(state, slip, gains), state.steps)
    ran = np.where(breaks, 0.0, state.clock)
    caught = runs & (ran >= steps)
    clock = np.where(rests, state.clock + 1.0, 0.0)
    clock = np.where(caught, -float(gains.rest), np.where(runs, ran + 1.0, clock))
    reach, brake = _learned(state, slip, gains, measured)
    new = np.where(falls & ~lost, gains.keep * ratio, np.where(measured, gains.again * ratio, ratio))
    calm = (falls & ~lost) | (rests & (state.clock > -0.4 * gains.rest)) | ~(slip.wanted | runs)
    steady = (state.last > 0.0) & (state.clock == 0.0) & ~lost
    memory = LeapState(
        load=np.where(calm, smoothed(load, slip.load), load),
        last=slip.load,
        noise=np.where(steady, noise_of(slip.load, state.last, load, state.noise, gains), state.noise),
        ratio=new,
        clock=clock,
        steps=steps,
        left=np.where(slip.begins | measured, slip.distance, state.left),
        reach=reach,
        brake=brake,
    )
    resting = gains.start * ratio * memory.load
    doubled = 2.0 * gains.start * np.maximum(ratio, slip.f_slip) * memory.load
    force = np.where(falls | runs, np.minimum(new * memory.load, slip.held), slip.held)
    force = np.where(rests, np.where(state.clock < gains.firm - gains.rest, doubled, resting), force)
    force = np.where(runs & slip.turning, state.brake * ratio * memory.load, force)
    return np.where(caught, force_max, force), memory


def smoothed(load: np.ndarray, now: np.ndarray) -> np.ndarray:
    """Smoothed load at rest after another measured one, (n,) [N]."""
    return load + 0.3 * (now - load)


def break_away(load: np.ndarray, noise: np.ndarray, gains: LeapGains) -> np.ndarray:
    """Fall of the load that is a break-away, (n,) [N].

    Args:
        load: Smoothed load at rest, (n,) [N].
        noise: Standard deviation of the measured load, (n,) [N].
        gains: The gains.
    """
    return np.maximum(gains.fall * np.maximum(load, LEAST_LOAD), gains.deviations * noise)


def noise_of(
    now: np.ndarray, last: np.ndarray, load: np.ndarray, noise: np.ndarray, gains: LeapGains
) -> np.ndarray:
    """Standard deviation of the measured load after another control step at rest, (n,) [N].

    Args:
        now: Measured load, (n,) [N].
        last: That of the control step before, (n,) [N].
        load: Smoothed load, (n,) [N].
        noise: The standard deviation before, (n,) [N].
        gains: The gains.
    """
    change = np.minimum(np.abs(now - last) / 1.13, gains.quiet * load)  # 1.13: mean of |x1 - x2|
    return noise + 0.05 * (change - noise)


def _steps(state: LeapState, slip: Slip, gains: LeapGains) -> np.ndarray:
    """Control steps to give a leap, (n,)."""
    length = np.clip(gains.share * slip.distance, 0.0, gains.slide)
    steps = np.clip(np.floor(np.sqrt(length / state.reach) - BEGUN), 0, gains.slide_steps)
    return np.where(slip.turning, gains.turn_steps, steps)


def _learned(
    state: LeapState, slip: Slip, gains: LeapGains, measured: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Reach of a slide and brake of a turn after a leap that is measured now; each (n,)."""
    length = np.maximum(state.left - slip.distance, 0.0)
    seen = length / (state.steps + BEGUN) ** 2
    reach = np.maximum(0.7 * state.reach, 0.5 * (state.reach + seen))  # not less: it may have been no leap
    asked = np.clip(gains.share * state.left, 0.0, gains.turn)
    over = np.clip((length + 0.2 * asked + 1e-6) / (1.2 * asked + 1e-6), 0.2, 5.0)
    brake = np.clip(state.brake * over**gains.learn, 0.5 * gains.start, 1.25 * gains.start)
    return (
        np.where(measured & ~slip.turning, reach, state.reach),
        np.where(measured & slip.turning, brake, state.brake),
    )
