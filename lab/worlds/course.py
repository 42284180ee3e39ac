"""Simulates a pad under a prescribed motion and normal force."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from lab.worlds.friction import LARGEST_R, NO_LOAD, at_load, friction
from lab.worlds.pad import pad
from lab.worlds.scenario import Contact, Scenario
from lab.worlds.trace import COLUMNS, Trace, keep
from slipgym._numba.compiled import compiled

RATE = 6000
"""Steps in a second [Hz]."""
BEGIN, END = 0.4, 0.2
"""Rest before the first and after the last slip, less the rest between two of them [s]."""
LAG = 0.01
"""Time constant of the normal force [s]."""
LARGEST_FORCE = 45.0  # [N]
STEP, SPREAD = 0.7, 0.7
"""Duration of a step of the normal force [s]; its logarithm is uniform up to this [-]."""
SWING, FREQUENCY = 0.4, 0.7
"""Amplitude over the mean of a force that is a sine [-], and its frequency [Hz]."""
KINDS = {"slide": ("slide",) * 3, "spin": ("spin",) * 2, "mixed": ("mixed",) * 3}
"""Motion -> its slips; those of a course are four drawn from `ALL`."""
ALL = "slide", "spin", "mixed", "slow"
SPIN_LIMIT = 8.0
"""Largest omega [rad/s]."""


@dataclass(frozen=True)
class Slip:
    """One slip: from rest to a constant scaled speed and back."""

    begin: float
    """[s]"""
    duration: float
    """[s]"""
    rise: float
    """Time to full speed, and back to rest [s]."""
    speed: float
    """Scaled, sqrt(v_t^2 + (r omega)^2) [m/s]."""
    gamma_t: float
    """v_t over the scaled speed [-]."""
    heading: float
    """Direction of v_t at the beginning [rad]."""
    turn: float
    """Its rate [rad/s]."""
    sense: int
    """Sign of omega."""

    def twist(self, t: NDArray[np.float64], r: float) -> NDArray[np.float64]:
        """v_x, v_y, omega at times (n,), (n, 3) [m/s, m/s, rad/s]."""
        since, left = t - self.begin, self.begin + self.duration - t
        speed = self.speed * np.clip(np.minimum(since, left) / self.rise, 0.0, 1.0)
        angle = self.heading + self.turn * since
        omega = self.sense * math.sqrt(1.0 - self.gamma_t**2) * speed / r
        v_t = self.gamma_t * speed
        return np.column_stack((v_t * np.cos(angle), v_t * np.sin(angle), omega))


def simulate_course(scenario: Scenario, rng: np.random.Generator) -> Trace:
    """The trace of a scenario whose motion is prescribed.

    Args:
        scenario: The scenario.
        rng: Draws the slips and the normal force.
    """
    contact = scenario.contact
    slips = _slips(scenario, rng)
    t = np.arange(int((slips[-1].begin + slips[-1].duration + scenario.rest + END) * RATE)) / RATE
    middle = slips[len(slips) // 2]
    jump = middle.begin + 0.4 * middle.duration
    base = friction_at(contact, t >= jump)
    motion = sum((slip.twist(t, contact.r) for slip in slips), np.zeros((len(t), 3)))
    course = np.column_stack((motion, _normal(scenario, slips, t, rng)))
    values = np.zeros((len(t), COLUMNS))
    law = contact.law._replace(reference=scenario.normal)
    _follow(course, base, pad(contact.shape), law, 1.0 / RATE, values)
    return Trace(RATE, values, [slip.begin + slip.duration - slip.rise - 0.02 for slip in slips], jump)


def friction_at(contact: Contact, jumped: NDArray[np.bool_]) -> NDArray[np.float64]:
    """mu_c, mu_s, r at the reference load, (n, 3) [-, -, m].

    Args:
        contact: The pads.
        jumped: Whether friction has jumped, (n,).
    """
    mu_c = contact.mu_c * np.where(jumped, contact.jump, 1.0)
    r = np.minimum(contact.r * np.where(jumped, contact.jump_r, 1.0), LARGEST_R)
    return np.column_stack((mu_c, contact.ratio * mu_c, r))


def _slips(scenario: Scenario, rng: np.random.Generator) -> list[Slip]:
    """Slips of a motion, one after the other."""
    kinds = KINDS.get(scenario.motion) or [ALL[k] for k in rng.integers(0, len(ALL), 4)]
    straight, first = rng.random() < 0.4, rng.uniform(0.0, 2.0 * np.pi)
    t, slips = BEGIN, []
    for kind in kinds:
        duration = rng.uniform(0.8, 2.5)
        rise = duration * rng.uniform(0.02, 0.3)
        speed = rng.uniform(0.0007, 0.004) if kind == "slow" else np.exp(rng.uniform(*np.log([0.005, 0.06])))
        free = rng.uniform(0.15, 0.97) if kind == "mixed" else rng.choice([1.0, 0.6])
        gamma_t = {"slide": 1.0, "spin": 0.0}.get(kind, free)
        if gamma_t < 1.0:
            speed = min(speed, SPIN_LIMIT * scenario.contact.r / math.sqrt(1.0 - gamma_t**2))
        heading, turn = rng.uniform(0.0, 2.0 * np.pi), rng.normal(0.0, 1.0)
        path = (first, 0.0) if straight else (heading, turn)
        slips.append(Slip(t, duration, rise, speed, gamma_t, *path, int(rng.choice([-1, 1]))))
        t += duration + scenario.rest
    return slips


def _normal(
    scenario: Scenario, slips: list[Slip], t: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """Normal force at times (n,) [N], behind the actuator's lag."""
    f_n = np.full(len(t), scenario.normal)
    if scenario.grip == "sine":
        f_n *= 1.0 + SWING * np.sin(2.0 * np.pi * FREQUENCY * t)
    elif scenario.grip == "steps":
        number = (t / STEP).astype(int)
        f_n *= np.exp(rng.uniform(-SPREAD, SPREAD, number[-1] + 1))[number]
    f_n = np.minimum(f_n, LARGEST_FORCE)
    if scenario.regrasp:
        f_n[(t > slips[0].begin + slips[0].duration + 0.05) & (t < slips[1].begin - 0.05)] = 0.0
    part = 1.0 - math.exp(-1.0 / (LAG * RATE))
    found = lfilter([part], [1.0, part - 1.0], f_n, zi=[f_n[0] * (1.0 - part)])[0]
    return np.where(found < 1e-3, 0.0, found)


@compiled
def _follow(course, base, pad, law, h, values):
    """Fills the values of a trace.

    Args:
        course: v_x, v_y, omega, f_n, (n, 4) [m/s, m/s, rad/s, N].
        base: mu_c, mu_s, r at the reference load, (n, 3) [-, -, m].
        pad: Pad.
        law: Law.
        h: Time step [s].
        values: Output (n, COLUMNS).
    """
    z, out = np.zeros((max(1, len(pad.weights)), 3)), np.zeros(6)
    for i in range(len(course)):
        twist, f_n = course[i, :3], course[i, 3]
        here = at_load(law, f_n, base[i, 0], base[i, 1], base[i, 2])
        if f_n < NO_LOAD:
            z[:] = 0.0
            out[:] = 0.0
        else:
            friction(z, pad, law, here, twist, h, out)
        keep(values[i], twist, here, out)
