"""Maps uniform random numbers to initial conditions of many episodes, in compiled code.

`shares` (m, k) and `u` are uniform random numbers in [0, 1), `numbers` NUMBER records, `choices` the choices
of all distributions; `scale` is 0 for the nominal values and 1 for the full ranges and probabilities.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import distribution, hardware
from slipgym.tasks.disturbance import add_push
from slipgym.tasks.episode import whole_steps

BLENDED, PLAIN, GATED = range(3)
"""What becomes of a sampled number: interpolated from the nominal one by the scale; taken as it is; or taken
with the scale as probability, else the nominal one."""
SPARE = {"speed_slope": "stribeck_velocity", "stiction": "dead_time"}
"""Field -> a number before it whose second random number it takes: it moves no other's."""
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
    """Map uniform random numbers to the values of episodes (m, s), of s numbers."""
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
    """Write the disturbances of the randomization, DISTURBANCE (d,), into some rows (m,) of EPISODE (n,).

    Their distributions are `numbers` (d, p), in the order of `KINDS`. step_time and the pushes of the task
    must be set. `happens` is output: whether each disturbance happens, (m, d).
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
    """Write a disturbance into an EPISODE record: `kind` is its place in `KINDS`, `u` has 8 numbers."""
    dt = episode.step_time
    first = sampled(numbers[0], choices, u[0])
    second = sampled(numbers[1], choices, u[1])
    if kind == PUSH:
        begin, steps = whole_steps(first, dt), max(1, whole_steps(second, dt))
        impulse, heading = sampled(numbers[2], choices, u[2]), sampled(numbers[3], choices, u[3])
        add_push(episode, begin, steps, impulse, heading, sampled(numbers[4], choices, u[4]))
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


GIVEN = np.dtype(
    [
        ("scale", "f8"),  # of the randomization, 0 to 1
        ("force", "f8"),  # grip force per finger [N]
        # options; NaN or -1 if they are left open
        ("material", "i8"),  # place in the sorted names
        ("mu_s", "f8"),
        ("mu_c", "f8"),
        ("r", "f8"),
        ("object_mass", "f8"),
        ("object_com", "f8", 2),
        # the object of configuration or options
        ("mass", "f8"),
        ("mass_range", "f8", 2),  # NaN: it has `mass`
        ("friction_range", "f8", 2),  # of mu_c; NaN: the material's
        ("radius_range", "f8", 2),  # of r; NaN: that of the pressure
        ("size", "f8", 3),
        ("com_offset", "f8", 2),
        ("grasp_offset", "f8", 2),
        ("inertia", "f8"),  # NaN: a uniform box
    ]
)
"""What options, settings and configuration give for episodes, in the units of START."""

_box_inertia = compiled(hardware.box_inertia)


@compiled
def compose(picked, further, given, materials, radii, values, starts, episodes, blank):
    """Fill in the sampled initial conditions of episodes, and what the episodes of all tasks have in common.

    Args:
        picked: A material for each, sampled from all, (m,).
        further: Uniform random numbers in [0, 1) for a mass from `mass_range`, mu_c from `friction_range`
            and r from `radius_range`, (m, 3).
        given: GIVEN (1,).
        materials: mu_s and mu_c of each material, (p, 2).
        radii: Radius r by pressure profile [m].
        values: VALUES (m,); the latencies are rounded.
        starts: START (m,) with the rows, output.
        episodes: EPISODE (n,), output.
        blank: Initial values of every episode, EPISODE (1,).

    Returns:
        Whether pads and centre of mass lie on every object.
    """
    own, valid = given[0], True
    for k in range(starts.shape[0]):
        start, value = starts[k], values[k]
        value.slip_latency = np.rint(value.slip_latency)
        start.force = own.force
        start.pressure = np.int64(value.pressure)
        set_friction(start, own, value, materials, picked[k], further[k, 1])
        r = radii[start.pressure]
        if not math.isnan(own.radius_range[0]):
            r = own.radius_range[0] + (own.radius_range[1] - own.radius_range[0]) * further[k, 2]
        start.friction[2] = value.radius_scale * r if math.isnan(own.r) else own.r
        set_object(start, own, value, further[k, 0])
        valid &= inside(start.com_offset, start.size, 0.0)
        valid &= inside(start.grasp_offset, start.size, blank[0].pad_radius)
        episodes[start.row] = blank[0]
        begin_episode(episodes[start.row], start, value)
    return valid


@compiled
def set_friction(start, own, value, materials, picked, share):
    """Set the material, mu_s and mu_c: the options' values, else sampled ones, else the material's.

    If a material is given, friction is not sampled. A range of the task takes the place of the material's
    mu_c, with the material's ratio of the two. Options that fix only mu_s or only mu_c keep the sampled
    ratio of the two.
    """
    start.material = own.material
    free = own.material < 0
    if free:
        start.material = picked if value.materials < 0.0 else np.int64(value.materials)
    mu_s, mu_c = materials[start.material, 0], materials[start.material, 1]
    least, most = own.friction_range[0], own.friction_range[1]
    ranged = free and not math.isnan(least)
    if ranged:
        scale = least * (most / least) ** share / mu_c
        mu_s, mu_c = scale * mu_s, scale * mu_c
    drawn_s, drawn_c = math.nan, value.mu_c
    given = not (math.isnan(value.mu_c) and math.isnan(value.mu_s) and math.isnan(value.friction_ratio))
    if ranged or (free and given):
        drawn_c = mu_c if math.isnan(value.mu_c) else value.mu_c
        ratio = mu_s / mu_c if math.isnan(value.friction_ratio) else value.friction_ratio
        drawn_s = ratio * drawn_c if math.isnan(value.mu_s) else value.mu_s
        mu_s, mu_c = blend(mu_s, drawn_s, own.scale), blend(mu_c, drawn_c, own.scale)
        if not math.isnan(own.mu_s):
            mu_c *= own.mu_s / mu_s
        elif not math.isnan(own.mu_c):
            mu_s *= own.mu_c / mu_c
    start.friction[0] = mu_s if math.isnan(own.mu_s) else own.mu_s
    start.friction[1] = mu_c if math.isnan(own.mu_c) else own.mu_c


@compiled
def set_object(start, own, value, share):
    """Set the object: the given one, with what is sampled or options fix."""
    scale, size = value.size_scale, start.size
    size[0], size[1], size[2] = scale * own.size[0], own.size[1], scale * own.size[2]
    for a in range(2):
        start.grasp_offset[a] = scale * own.grasp_offset[a]
    start.com_offset[0] = scale * own.com_offset[0] + value.com_x * size[0]
    start.com_offset[1] = scale * own.com_offset[1] + value.com_z * size[2]
    if not math.isnan(own.object_com[0]):
        start.com_offset[0], start.com_offset[1] = own.object_com[0], own.object_com[1]
    mass, low, high = own.mass, own.mass_range[0], own.mass_range[1]
    if not math.isnan(low):
        mass = low + (high - low) * share
    start.mass = value.mass_scale * mass if math.isnan(own.object_mass) else own.object_mass
    start.inertia = _box_inertia(start.mass, size[0], size[2])
    if not math.isnan(own.inertia):
        start.inertia = own.inertia * value.mass_scale * scale**2


@compiled
def inside(point, size, margin):
    """Whether a point (x, z) lies on an object (x, y, z), `margin` away from its edges."""
    return abs(point[0]) <= size[0] / 2 - margin and abs(point[1]) <= size[2] / 2 - margin


@compiled
def begin_episode(episode, start, value):
    """Fill in the fields of an EPISODE record that all tasks have in common, from START and VALUES."""
    episode.mass, episode.inertia = start.mass, start.inertia
    episode.mu_s, episode.mu_c, episode.drift = start.friction[0], start.friction[1], value.friction_drift
    episode.r = 0.5 * (value.finger_radius[0] + value.finger_radius[1]) * start.friction[2]
    for a in range(2):
        episode.reach[a] = start.size[2 * a] / 2 - episode.pad_radius
        episode.object_centre[a] = -start.grasp_offset[a]
        episode.finger_friction[a] = value.finger_friction[a]
