"""Computes the friction of a pad: elasto-plastic bristles, in series with the springs of a soft pad.

A cell with the load f has a deflection z. At the slip velocity v, with g(v) between mu_c and mu_s (Stribeck),

    dz/dt = v - b(z) |v| z / z_max,    z_max = g(v) f / k,
    force = -(k z + d dz/dt + sigma_2 f v)

b is 0 below nine tenths of z_max, so that a bristle does not creep, and 1 from z_max on (Dupont et al.,
Single state elastoplastic friction models, IEEE TAC 47, 2002). A rigid pad has k = sigma_0 f. A soft pad has
bristle and spring in series, 1 / k = c / a + 1 / (sigma_0 f) with the pad's compliance c and the cell's
fraction a of its area: in shear the springs add up to c, in torsion to c over the mean square of the radius.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from slipgym._numba.compiled import compiled

BREAKAWAY = 0.9
"""Fraction of the largest deflection from which on a bristle yields."""
LOSS = 1.6e-3
"""Time constant of a soft pad's damping, a loss factor of 0.1 at 10 Hz [s]."""
SIGMA_1 = 60.0
"""Damping of a rigid pad's bristles over the normal force [s/m]."""
LARGEST_R = 0.0145
"""Radius that the load does not widen the patch beyond [m]."""
RANGE = 0.1, 10.0
"""Normal force over the reference, outside of which friction depends on the load no more [-]."""
NO_LOAD = 0.02
"""Normal force below which a pad does not touch [N]."""


class Law(NamedTuple):
    """Constants of a pad's friction."""

    stribeck: float
    """Speed over which static friction falls to Coulomb friction [m/s]."""
    sigma_0: float
    """Stiffness of the bristles over the normal force [1/m]."""
    sigma_1: float
    """Their damping over the normal force [s/m]."""
    sigma_2: float
    """Viscous friction over the normal force [s/m]."""
    compliance: float = 0.0
    """Of the pad in shear, 0 for a rigid one [m/N]."""
    falls: float = 0.0
    """mu falls with the normal force to the power of this [-]."""
    grows: float = 0.0
    """r grows with the normal force to the power of this [-]."""
    reference: float = 1.0
    """Normal force at which mu and r are those of the scenario [N]."""
    stretch: float = 0.0
    """Friction along x is larger by this, along y smaller [-]."""


@compiled
def at_load(law, f_n, mu_c, mu_s, r):
    """f_n [N], mu_c, mu_s [-] and r [m] at a normal force, from those at the reference."""
    ratio = min(max(f_n / law.reference, RANGE[0]), RANGE[1])
    scale = ratio**-law.falls
    return f_n, scale * mu_c, scale * mu_s, min(r * ratio**law.grows, max(r, LARGEST_R))


@compiled
def advance(z, v, n, slide, static, stribeck, h, rate):
    """Deflects a bristle for h [s] by the exact solution at constant v.

    Args:
        z: Deflection, (n,) [m]; changed in place.
        v: Slip velocity, (n,) [m/s].
        n: Components.
        slide: Deflection in fast slip [m].
        static: Largest deflection [m].
        stribeck: Stribeck speed [m/s].
        h: Duration [s].
        rate: Output, mean velocity of the deflection (n,) [m/s].
    """
    speed, size, along = 0.0, 0.0, 0.0
    for k in range(n):
        speed += v[k] * v[k]
        size += z[k] * z[k]
    speed, size = math.sqrt(speed), math.sqrt(size)
    if size > static:  # the load has fallen: what it cannot hold slips back
        for k in range(n):
            z[k] *= static / size
        size = static
    for k in range(n):
        rate[k] = v[k]
        along += v[k] * z[k]
    most = slide + (static - slide) * math.exp(-((speed / stribeck) ** 2))
    start = BREAKAWAY * most
    yields = 0.0 if size <= start else 1.0
    if start < size < most:
        yields = 0.5 + 0.5 * math.sin(math.pi * ((size - start) / (most - start) - 0.5))
    if size > 0.0 and speed > 0.0:
        yields *= 0.5 + 0.5 * along / (speed * size)  # a bristle that is relieved does not slip
    decay = yields * speed / most
    if decay * h < 1e-9:
        for k in range(n):
            z[k] += v[k] * h
        return
    left = math.exp(-decay * h)
    for k in range(n):
        before = z[k]
        z[k] = before * left + v[k] * (1.0 - left) / decay
        rate[k] = (z[k] - before) / h


@compiled
def stiffness(law, load, area):
    """Stiffness [N/m] and damping [N s/m] of a cell.

    Args:
        law: Law.
        load: Normal force of the cell [N].
        area: Fraction of the pad's area [-].
    """
    bristle, damping = law.sigma_0 * load, law.sigma_1 * load
    if law.compliance == 0.0:
        return bristle, damping
    series = 1.0 / (law.compliance / area + 1.0 / bristle)
    return series, min(damping, LOSS * series)


@compiled
def friction(z, pad, law, here, twist, h, out):
    """Advances a pad's bristles by h [s] under a constant twist.

    Args:
        z: Deflections, (max(m, 1), 3) [m]; changed in place.
        pad: Pad of m cells.
        law: Law.
        here: f_n, mu_c, mu_s, r at this load, of `at_load`.
        twist: v_x, v_y, omega of the object against the finger [m/s, m/s, rad/s].
        h: Duration [s].
        out: Output (6,): friction on the object f_x, f_y, tau [N, N, N m]; its twist without that of the
            springs and bristles v_x, v_y, omega [m/s, m/s, rad/s].
    """
    f_n, mu_c, mu_s, r = here
    v, rate = np.empty(3), np.empty(3)
    a_x, a_y = 1.0 + law.stretch, 1.0 - law.stretch
    out[:] = 0.0
    if len(pad.weights) == 0:
        k, d = stiffness(law, f_n, 1.0)
        v[0], v[1], v[2] = a_x * twist[0], a_y * twist[1], r * twist[2]
        advance(z[0], v, 3, mu_c * f_n / k, mu_s * f_n / k, law.stribeck, h, rate)
        for j, scale in enumerate((a_x, a_y, r)):
            out[j] = -scale * (k * z[0, j] + d * rate[j] + law.sigma_2 * f_n * v[j])
            out[3 + j] = (v[j] - rate[j]) / scale
        return
    radius, square = r / pad.ratio, 0.0
    for i in range(len(pad.weights)):
        x, y, load = radius * pad.places[i, 0], radius * pad.places[i, 1], f_n * pad.weights[i]
        k, d = stiffness(law, load, pad.areas[i])
        v[0], v[1] = a_x * (twist[0] - twist[2] * y), a_y * (twist[1] + twist[2] * x)
        advance(z[i], v, 2, mu_c * load / k, mu_s * load / k, law.stribeck, h, rate)
        f_x = -a_x * (k * z[i, 0] + d * rate[0] + law.sigma_2 * load * v[0])
        f_y = -a_y * (k * z[i, 1] + d * rate[1] + law.sigma_2 * load * v[1])
        s_x, s_y = (v[0] - rate[0]) / a_x, (v[1] - rate[1]) / a_y
        out[0], out[1], out[2] = out[0] + f_x, out[1] + f_y, out[2] + x * f_y - y * f_x
        weight = pad.weights[i]
        out[3], out[4] = out[3] + weight * s_x, out[4] + weight * s_y
        out[5] += weight * (x * s_y - y * s_x)
        square += weight * (x * x + y * y)
    out[5] /= square


@compiled
def elastic(z, pad, law, f_n):
    """Energy that bristles and springs hold [J]; arguments as of `friction`."""
    energy = 0.0
    for i in range(len(z)):
        cells = len(pad.weights) > 0
        k, _ = stiffness(law, f_n * pad.weights[i] if cells else f_n, pad.areas[i] if cells else 1.0)
        for j in range(2 if cells else 3):
            energy += 0.5 * k * z[i, j] * z[i, j]
    return energy
