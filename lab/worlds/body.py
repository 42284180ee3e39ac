"""Simulates a rigid body between two equal pads: a grip that lets it leap, or gravity that turns it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lab.worlds.course import LARGEST_FORCE, friction_at
from lab.worlds.friction import NO_LOAD, Law, at_load, friction
from lab.worlds.pad import pad
from lab.worlds.scenario import Scenario
from lab.worlds.trace import COLUMNS, Trace, keep
from slipgym._numba.compiled import compiled

RATE = 12000
"""Steps in a second [Hz]."""
DURATION, JUMP, REGRASP = 9.0, 5.0, 3.5
"""Of the record; time of the jump of friction; time at which the gripper opens once more [s]."""
OPEN = 0.04
"""For how long it does [s]."""
START = 0.5
"""Time from which on the grip falls or gravity turns [s]."""
MARKS = [4.9, 8.9]
"""Times at which estimates are evaluated [s]."""
GRAVITY = 9.81  # [m/s^2]
GYRATION = 0.04
"""Radius of gyration [m]."""
STABLE = 0.25
"""Largest stiffness times the square of the time step over the mass of a stable explicit step [-]."""


class Body(NamedTuple):
    """A rigid body and what pulls at it."""

    mass: float
    """[kg]"""
    inertia: float
    """About the centre of mass [kg m^2]."""
    c_x: float
    """Centre of mass from the grip [m]."""
    c_y: float
    """The same along y."""
    g_x: float
    """Gravity in the pad's plane at first [m/s^2]."""
    g_y: float
    """The same along y."""
    turn: float
    """Rate at which gravity turns [rad/s]."""


class Grip(NamedTuple):
    """A grip that is lowered until the body slips, closed at a speed, and after a while lowered again."""

    least: float
    """Least force [N]."""
    most: float
    """Force of the closed grip [N]."""
    ramp: float
    """Rate at which it is lowered [N/s]."""
    catch: float
    """Scaled slip speed at which it closes [m/s]; infinite: never."""
    wait: float
    """Time that it stays closed [s]."""
    lag: float
    """Time constant of the actuator [s]."""
    opens: float
    """Time at which it opens for `OPEN` [s]; infinite: never."""


@dataclass(frozen=True)
class Held:
    """Body, grip and law that belong together."""

    body: Body
    grip: Grip
    law: Law


def simulate_body(scenario: Scenario, rng: np.random.Generator) -> Trace:
    """The trace of a scenario whose motion is that of a body.

    Args:
        scenario: The scenario.
        rng: Draws body and grip.
    """
    contact, held = scenario.contact, hold(scenario, rng)
    t = np.arange(int(DURATION * RATE)) / RATE
    base = friction_at(contact, t >= JUMP)
    values = np.zeros((len(t), COLUMNS))
    _move(held.body, held.grip, pad(contact.shape), held.law, base, 1.0 / RATE, values)
    return Trace(RATE, values, list(MARKS), JUMP)


def hold(scenario: Scenario, rng: np.random.Generator) -> Held:
    """Draws a body that the gripper can hold within `LARGEST_FORCE`, and how it is held."""
    contact, hinge = scenario.contact, scenario.motion == "hinge"
    mass, angle = rng.uniform(0.05, 0.5), rng.uniform(0.0, 2.0 * np.pi)
    lever = rng.uniform(0.03, 0.1) if hinge else rng.uniform(0.0, 0.01)
    aside = angle if hinge else angle + 1.0
    # forces over the mass of the body: what holds it, with a margin for the moment of a hinge [m/s^2]
    share = 0.5 * GRAVITY / contact.mu_c * (1.35 if hinge else 1.0)
    most = share * rng.uniform(1.5, 3.0) * max(1.0, 1.0 / contact.jump)
    if not hinge:
        most += 0.5 * GRAVITY * lever / (contact.mu_c * contact.r)  # the moment of the weight
    mass = min(mass, LARGEST_FORCE / most)
    need, most = share * mass, most * mass
    body = Body(
        mass=mass,
        inertia=mass * GYRATION**2,
        c_x=lever * math.cos(aside),
        c_y=lever * math.sin(aside),
        g_x=GRAVITY * math.cos(angle),
        g_y=GRAVITY * math.sin(angle),
        turn=rng.uniform(0.2, 0.6) if hinge else 0.0,
    )
    grip = Grip(
        least=need if hinge else 0.02 * need,
        most=most,
        ramp=need * rng.uniform(0.5, 4.0),
        catch=rng.uniform(0.003, 0.04) + (math.inf if hinge else 0.0),
        wait=rng.uniform(0.05, 0.5),
        lag=rng.uniform(0.004, 0.02),
        opens=REGRASP if scenario.regrasp else math.inf,
    )
    stiffest = STABLE * mass / most * RATE**2
    law = contact.law._replace(
        reference=max(need, 0.1),
        sigma_0=min(contact.law.sigma_0, stiffest),
        sigma_1=min(contact.law.sigma_1, stiffest / RATE),
    )
    return Held(body, grip, law)


@compiled
def _goal(grip, t, h, speed, state):
    """Force that the grip is to have [N].

    Args:
        grip: Grip.
        t: Time [s].
        h: Time step [s].
        speed: Scaled slip speed [m/s].
        state: The last goal [N] and for how long the body has been still since it was caught [s], (2,).
    """
    if t <= START:
        return state[0]
    if speed > grip.catch:
        state[0], state[1] = grip.most, 0.0
    elif state[0] < grip.most or state[1] >= grip.wait or grip.catch == math.inf:
        state[0] = max(grip.least, state[0] - grip.ramp * h)
    else:
        state[1] += h
    return state[0]


@compiled
def _move(body, grip, pad, law, base, h, values):
    """Fills the values of a trace.

    Args:
        body: Body.
        grip: Grip.
        pad: Pad.
        law: Law.
        base: mu_c, mu_s, r at the reference load, (n, 3) [-, -, m].
        h: Time step [s].
        values: Output (n, COLUMNS).
    """
    z, out, twist = np.zeros((max(1, len(pad.weights)), 3)), np.zeros(6), np.zeros(3)
    state = np.array([grip.most, grip.wait])
    c_x, c_y, v_x, v_y, omega, force = body.c_x, body.c_y, 0.0, 0.0, 0.0, grip.most
    for i in range(len(values)):
        t = i * h
        twist[0], twist[1], twist[2] = v_x + omega * c_y, v_y - omega * c_x, omega  # of the body at the grip
        speed = math.sqrt(twist[0] ** 2 + twist[1] ** 2) + abs(omega) * base[i, 2]
        force += (_goal(grip, t, h, speed, state) - force) * h / grip.lag
        f_n = 0.0 if grip.opens < t < grip.opens + OPEN else force
        here = at_load(law, f_n, base[i, 0], base[i, 1], base[i, 2])
        if f_n < NO_LOAD:
            z[:] = 0.0
            out[:] = 0.0
        else:
            friction(z, pad, law, here, twist, h, out)
        keep(values[i], twist, here, out)
        f_x, f_y, tau = 2.0 * out[0], 2.0 * out[1], 2.0 * out[2]
        angle = body.turn * max(0.0, t - START)
        cos, sin = math.cos(angle), math.sin(angle)
        v_x += h * (f_x / body.mass + cos * body.g_x - sin * body.g_y)
        v_y += h * (f_y / body.mass + sin * body.g_x + cos * body.g_y)
        omega += h * (tau - c_x * f_y + c_y * f_x) / body.inertia
        c_x, c_y = c_x + h * v_x, c_y + h * v_y
