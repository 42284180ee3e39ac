"""What an episode draws or is told: friction of the pads and the box between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slipgym.config import Config
from slipgym.config.errors import unknown
from slipgym.config.hardware import box_inertia
from slipgym.config.task import TaskConfig
from slipgym.envs.draw import Draw
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.scene import Box


@dataclass(frozen=True)
class Friction:
    """True friction of an episode."""

    mu_s: float
    """Static friction [-]."""
    mu_c: float
    """Coulomb friction [-]."""
    r: float
    """Radius of the equivalent rim contact [m]."""
    material: str
    """Name of the material it came from."""


def draw_friction(
    config: Config,
    options: EpisodeOptions,
    task: TaskConfig,
    material: str,
    draw: Draw,
    rng: np.random.Generator,
) -> Friction:
    """The material's friction, randomised unless a material was named, with what the options fix.

    Options that fix one of mu_s and mu_c leave a randomised ratio as it was drawn.

    Raises:
        ValueError: The material is unknown, mu_s would be below mu_c, or the pad has no room for r.
    """
    names = sorted(config.materials)
    drawn = names[rng.integers(len(names))]  # drawn always, so that options do not shift later draws
    name = options.material or material
    random = name == "random"
    if random:
        name = draw.material or drawn
    if name not in config.materials:
        raise ValueError(unknown("material", name, ["random", *names]))
    mu_s, mu_c = config.materials[name].mu_s, config.materials[name].mu_c
    if random and draw.friction:
        mu_s, mu_c = draw.friction_of(config.materials[name])
        if options.mu_s is not None:
            mu_c *= options.mu_s / mu_s
        elif options.mu_c is not None:
            mu_s *= options.mu_c / mu_c
    mu_s, mu_c = options.mu_s or mu_s, options.mu_c or mu_c
    if mu_s < mu_c:
        raise ValueError(f"mu_s = {mu_s:g} must be at least mu_c = {mu_c:g} (material {name!r})")
    r = options.r or draw.values["radius_scale"] * (task.radius or draw.config.contact_radius)
    draw.config.check_patch("option r", r)
    return Friction(mu_s, mu_c, r, name)


def make_box(
    config: Config, options: EpisodeOptions, task: TaskConfig, draw: Draw, rng: np.random.Generator
) -> Box:
    """The object of the configuration, with what the task and the randomization draw and the options fix.

    Raises:
        ValueError: The pads or the centre of mass would not lie on the object.
    """
    default, values = task.object or config.object, draw.values
    mass = default.mass if task.mass_range is None else rng.uniform(*task.mass_range)
    mass *= values["mass_scale"]
    scale = 1.0 if options.object_size is not None else values["size_scale"]
    x, y, z = default.size if options.object_size is None else options.object_size
    size = scale * x, y, scale * z
    grasp_offset = scale * default.grasp_offset[0], scale * default.grasp_offset[1]
    com_offset = (
        scale * default.com_offset[0] + values["com_x"] * size[0],
        scale * default.com_offset[1] + values["com_z"] * size[2],
    )
    if options.object_mass is not None:
        mass = options.object_mass
    if options.com_offset is not None:
        com_offset = options.com_offset
    _check_inside("com_offset", com_offset, size, margin=0.0)
    _check_inside("grasp_offset", grasp_offset, size, margin=config.gripper.pad_radius)
    inertia = box_inertia(mass, size[0], size[2])
    if default.inertia is not None:
        inertia = default.inertia * values["mass_scale"] * scale**2
    return Box(
        size=size,
        com_offset=com_offset,
        grasp_offset=grasp_offset,
        mass=float(mass),
        inertia=float(inertia),
    )


def _check_inside(
    name: str, point: tuple[float, float], size: tuple[float, float, float], margin: float
) -> None:
    """Raise ValueError unless a point (x, z) lies on the object, `margin` away from its edges."""
    room = size[0] / 2 - margin, size[2] / 2 - margin
    if abs(point[0]) > room[0] or abs(point[1]) > room[1]:
        around = f" with the pad of radius {margin:g} m around it" if margin else ""
        raise ValueError(
            f"{name} {tuple(point)} m{around} must lie on the object, {size[0]:g} m by {size[2]:g} m"
        )


def checked_force(config: Config, settings: TaskConfig) -> float:
    """Grip force per finger at reset [N].

    Raises:
        ValueError: The gripper's force loop cannot hold it.
    """
    gripper, force = config.gripper, settings.initial_force
    if not gripper.force_min <= force <= gripper.force_max:
        raise ValueError(
            f"option initial_force = {force:g} N must lie within the gripper's "
            f"{gripper.force_min:g} to {gripper.force_max:g} N"
        )
    return force
