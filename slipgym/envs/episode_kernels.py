"""Combines sampled values, options and settings into initial conditions, in compiled code."""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import hardware
from slipgym.envs.sampling_kernels import blend

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
        ("pad_radius", "f8"),
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
        valid &= inside(start.grasp_offset, start.size, own.pad_radius)
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
    start.half_thickness = size[1] / 2
    for a in range(2):
        start.grasp_point[a] = start.grasp_offset[a] - start.com_offset[a]
        start.object_centre[a] = -start.grasp_offset[a]
        start.reach[a] = size[2 * a] / 2 - own.pad_radius


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
        episode.reach[a], episode.object_centre[a] = start.reach[a], start.object_centre[a]
        episode.finger_friction[a] = value.finger_friction[a]
