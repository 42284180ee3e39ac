"""The effects of a rubber pad on friction: load, shape, shear, creep and age. Each is off by default.

With f_n the normal force, f_0 `reference_force`, and all displacements scaled, (x, y, r theta):

    mu(f_n) = mu (f_n / f_0)^-load_exponent         friction of rubber falls with the load, of some
                                                    silicones it rises: then the exponent is negative
    r(f_n)  = r (f_n / f_0)^radius_exponent         at most `radius_max`; Xydas & Kao, Modeling of contact
                                                    mechanics and friction limit surfaces for soft fingers,
                                                    IJRR 18(9), 1999: 0 to 1/3, Hertz 1/3
    cop     = cop_0 + cop_lever f_t / f_n           the tangential load tilts the pad towards its leading edge
    f_t     = k (p + shear_time dp/dt - creep q)  shear p of the rubber between finger and bristles,
    dq/dt   = (p - q) / creep_time                  a standard linear solid of stiffness k = 1 / compliance
    mu_s(t) = mu_c + (mu_s - mu_c) (1 + aging ln(1 + t / aging_time))
    dt/dtime = 1 - v t / aging_distance             in slip at v; in stick the contact ages with time
                                                    (Dieterich, J. Geophys. Res. 84, 1979)

Shear and bristles are in series. In a sub-step h the force of the rubber is

    f_t = (dp + rear) / give,    rear = recall_0 p + recall_1 q + recall_2 v,

with dp the shear that it adds: p and q are those of its end, and so is dp/dt, which without cells is
extrapolated from dp / h and the same of the last sub-step, v. `slipgym.contact.bristle` solves both together
in closed form. The stiffness is the same in all scaled directions: k r^2 in torsion, where a disc that shears
evenly has k R^2 / 2 = 1.13 k r^2.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact import stribeck
from slipgym.contact.records import Pad, Vector

EXPANDED = 0.05
"""Change of the normal force over which load dependence is expanded [-]."""
AGED = 0.005
"""Change of the dwell time from which the static friction follows: it is then off by 0.0025 of `aging`."""
LIGHTEST = 1e-2  # [N]; load dependence ends here, where a pad no longer holds an object


@compiled
def load_pad(pad: Pad, normal: float) -> None:
    """Set a pad's normal force [N] and what depends on it."""
    pad.normal = normal
    pad.radius = pad.r
    pad.pressure_centre[0], pad.pressure_centre[1] = pad.cop[0], pad.cop[1]
    if pad.load_exponent != 0.0 or pad.radius_exponent != 0.0:
        expand_load(pad, max(normal, LIGHTEST))
    if pad.cop_lever != 0.0 and normal > LIGHTEST:
        shift = pad.cop_lever / normal
        pad.pressure_centre[0] += shift * pad.wrench[0]
        pad.pressure_centre[1] += shift * pad.wrench[1]


@compiled
def expand_load(pad: Pad, normal: float) -> None:
    """Set friction scale and radius by their third-order expansion about a normal force within 5 %."""
    anchor, x = pad.load_anchor, near_anchor(pad, normal)
    if not abs(x) < EXPANDED:
        anchor[0], anchor[3], x = normal, pad.r, 0.0
        anchor[1], anchor[2] = at_load(pad, normal)
    pad.friction_scale = anchor[1] * power(x, -pad.load_exponent)
    pad.radius = min(anchor[2] * power(x, pad.radius_exponent), pad.radius_max)


@compiled
def near_anchor(pad: Pad, normal: float) -> float:
    """Distance of a normal force from the anchor of the expansion, over that [-]; NaN if r is another one."""
    anchor = pad.load_anchor
    return normal / anchor[0] - 1.0 if anchor[3] == pad.r else math.nan


@compiled
def power(x: float, exponent: float) -> float:
    """(1 + x)^exponent for |x| < EXPANDED and an exponent of -1/2 to 2/5; to 2e-6."""
    second = 0.5 * (exponent - 1.0)
    third = (exponent - 2.0) / 3.0
    return 1.0 + exponent * x * (1.0 + second * x * (1.0 + third * x))


@compiled
def at_load(pad: Pad, normal: float) -> tuple[float, float]:
    """Factor of the friction [-] and radius r, not limited [m], at a normal force [N]."""
    ratio = math.log(max(normal, LIGHTEST) / pad.reference_force)
    return math.exp(-pad.load_exponent * ratio), pad.r * math.exp(pad.radius_exponent * ratio)


@compiled
def present_friction(pad: Pad) -> Vector:
    """Static and Coulomb friction [-] and radius r [m] at the last normal force and dwell time."""
    if pad.friction_scale == 1.0 and pad.static_gain == 1.0:
        return pad.mu_s, pad.mu_c, pad.radius
    mu_c, mu_s = stribeck.levels(pad)
    return mu_s, mu_c, pad.radius


@compiled
def static_limit(pad: Pad, normal: float) -> float:
    """Largest tangential force that a pad holds at a normal force, without growth by dwell time [N]."""
    if pad.load_exponent == 0.0:
        return pad.mu_s * normal
    x = near_anchor(pad, max(normal, LIGHTEST))
    if abs(x) < EXPANDED:
        return pad.load_anchor[1] * power(x, -pad.load_exponent) * pad.mu_s * normal
    return at_load(pad, normal)[0] * pad.mu_s * normal


@compiled
def prepare_shear(pad: Pad, h: float, ahead: float) -> None:
    """Set `give` and `recall` for a sub-step of h [s]; `ahead` 0: its end has its mean rate of shear."""
    if pad.compliance == 0.0:
        pad.give = 0.0
    elif pad.prepared != h or pad.ahead != ahead:  # sub-steps take few lengths
        pad.prepared, pad.ahead = h, ahead
        pad.relaxing = h / (pad.creep_time + h)
        relaxing = pad.creep * (1.0 - pad.relaxing)
        lasting = 1.0 - pad.creep + relaxing
        per_stiffness = 1.0 / (lasting + pad.shear_time * (1.0 + ahead) / h)
        pad.give = pad.compliance * per_stiffness
        pad.recall[0], pad.recall[1] = lasting * per_stiffness, -relaxing * per_stiffness
        pad.recall[2] = -ahead * pad.shear_time * per_stiffness


@compiled
def sheared(pad: Pad, shear: float, relaxed: float, gained: float) -> tuple[float, float]:
    """`shear` and `relaxed` of one direction after the shear has grown by `gained` in a sub-step [m]."""
    shear += gained
    return shear, relaxed + pad.relaxing * (shear - relaxed)


@compiled
def advance_shear(pad: Pad, motion: Vector, slip: Vector) -> None:
    """Advance the shear of a pad without cells: what of a scaled motion is not slip."""
    if pad.give > 0.0:
        for a in range(3):
            gained = motion[a] - slip[a]
            pad.shear[a], pad.relaxed[a] = sheared(pad, pad.shear[a], pad.relaxed[a], gained)
            pad.shear_rate[a] = gained / pad.prepared


@compiled
def advance_age(pad: Pad, slip_speed: float, h: float) -> None:
    """Age the contact over h: with time in stick (slip speed 0), towards that of a steady slip otherwise."""
    if pad.aging > 0.0:
        pad.dwell += h
        if slip_speed > 0.0:
            pad.dwell /= 1.0 + h * slip_speed / pad.aging_distance  # backward Euler
        if abs(pad.dwell - pad.aged) > AGED * pad.aged:
            pad.aged = pad.dwell
            pad.static_gain = 1.0 + pad.aging * math.log1p(pad.dwell / pad.aging_time)


@compiled
def let_go(pad: Pad) -> None:
    """Forget shear and age, as after a loss of contact."""
    pad.shear[:] = 0.0
    pad.relaxed[:] = 0.0
    pad.shear_rate[:] = 0.0
    pad.dwell = pad.aged = 0.0
    pad.static_gain = 1.0
