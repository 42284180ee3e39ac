"""Maps uniform random numbers to what a randomization samples, for many episodes, in compiled code."""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import distribution
from slipgym.tasks.episode import whole_steps

BLENDED, PLAIN, GATED = range(3)
"""What becomes of a sampled number: interpolated from the nominal one by the scale; taken as it is; or taken
with the scale as probability, else the nominal one."""
NUMBER = np.dtype(
    [
        ("at", "i8"),  # place of its uniform random number; -1: not sampled
        ("rule", "i8"),  # BLENDED, PLAIN or GATED, where the next random number decides
        ("nominal", "f8"),
        # of its distribution, see `slipgym.config.distribution`
        ("kind", "i8"),
        ("low", "f8"),
        ("high", "f8"),
        ("span", "f8"),
        ("first", "i8"),  # place of its choices, and behind them
        ("last", "i8"),
    ]
)
"""A number of an episode and how it is sampled."""
DISTURBANCE = np.dtype(
    [
        ("at", "i8"),  # place of its random numbers, of which the first decides whether it happens
        ("kind", "i8"),  # place in KINDS
        ("probability", "f8"),
    ]
)
"""A disturbance of the randomization."""
KINDS: dict[str, tuple[str, ...]] = {
    "push": ("time", "duration", "impulse", "direction", "lever"),
    "shake": ("amplitude", "pitch", "frequency"),
    "mass_change": ("time", "factor"),
    "friction_jump": ("time", "factor"),
    "surface_region": ("start", "length", "factor"),
}
"""Kind of a disturbance -> its distributions, in the order in which `schedule` takes them."""
PUSH, SHAKE, MASS_CHANGE, FRICTION_JUMP, SURFACE_REGION = range(len(KINDS))

_quantile = compiled(distribution.quantile)


@compiled
def sampled(number, choices, share):
    """The number of a distribution below which a fraction of the samples lies."""
    own = choices[number.first : number.last]
    return _quantile(number.kind, number.low, number.high, number.span, own, share)


@compiled
def blend(nominal, drawn, scale):
    """Interpolate between the value without randomization (scale 0) and the sampled one (scale 1)."""
    return (1.0 - scale) * nominal + scale * drawn


@compiled
def sample_values(shares, numbers, choices, scale, values):
    """Map uniform random numbers to the values of episodes.

    Args:
        shares: Uniform random numbers in [0, 1), (m, k).
        numbers: NUMBER (s,).
        choices: Choices of all distributions.
        scale: 0 for the nominal values, 1 for the full ranges.
        values: Output (m, s).
    """
    for j in range(numbers.shape[0]):
        number = numbers[j]
        for k in range(shares.shape[0]):
            value = number.nominal
            if number.at >= 0:
                drawn = sampled(number, choices, shares[k, number.at])
                if number.rule == BLENDED:
                    value = blend(value, drawn, scale)
                elif number.rule == PLAIN or shares[k, number.at + 1] < scale:
                    value = drawn
            values[k, j] = value


@compiled
def schedule(shares, disturbances, numbers, choices, scale, rows, episodes, happens):
    """Write the disturbances of the randomization into episodes.

    Args:
        shares: Uniform random numbers in [0, 1), (m, k).
        disturbances: DISTURBANCE (d,).
        numbers: Their distributions, NUMBER (d, p), in the order of `KINDS`.
        choices: Choices of all distributions.
        scale: Factor of the probabilities.
        rows: Which episodes, (m,).
        episodes: EPISODE (n,); step_time and the pushes of the task must be set.
        happens: Output, whether each disturbance happens, (m, d).
    """
    for k in range(rows.shape[0]):
        for j in range(disturbances.shape[0]):
            own = disturbances[j]
            u = shares[k, own.at :]
            happens[k, j] = u[0] < scale * own.probability
            if happens[k, j]:
                write_disturbance(own.kind, numbers[j], choices, u[1:], episodes[rows[k]])


@compiled
def write_disturbance(kind, numbers, choices, u, episode):
    """Write a disturbance into an episode.

    Args:
        kind: Its place in `KINDS`.
        numbers: Its distributions, NUMBER (p,).
        choices: Choices of all distributions.
        u: Uniform random numbers in [0, 1), at least 8.
        episode: EPISODE record.
    """
    dt = episode.step_time
    first = sampled(numbers[0], choices, u[0])
    second = sampled(numbers[1], choices, u[1])
    if kind == PUSH:
        begin, steps = whole_steps(first, dt), max(1, whole_steps(second, dt))
        force = sampled(numbers[2], choices, u[2]) / (steps * dt)
        heading, lever = sampled(numbers[3], choices, u[3]), sampled(numbers[4], choices, u[4])
        k = episode.pushes
        episode.push_start[k], episode.push_end[k] = begin, begin + steps
        episode.push_wrench[k, 0] = force * math.cos(heading)
        episode.push_wrench[k, 1] = force * math.sin(heading)
        episode.push_wrench[k, 2] = force * lever
        episode.pushes = k + 1
    elif kind == SHAKE:
        for axis in range(3):
            episode.shakes[1, axis, 0] = second if axis == 2 else first
            episode.shakes[1, axis, 1] = math.tau * sampled(numbers[2], choices, u[2 + axis])
            episode.shakes[1, axis, 2] = math.tau * u[5 + axis]
    elif kind == MASS_CHANGE:
        episode.mass_step, episode.mass_factor = whole_steps(first, dt), second
    elif kind == FRICTION_JUMP:
        episode.jump_step, episode.jump_factor = whole_steps(first, dt), second
    elif kind == SURFACE_REGION:
        episode.region[0], episode.region[1] = first, first + second
        episode.region_factor = sampled(numbers[2], choices, u[2])
