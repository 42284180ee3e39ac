"""What an episode draws or is told: friction of the pads and the box between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slipgym.config import Config
from slipgym.config.errors import unknown
from slipgym.config.tasks import HoldConfig, TaskConfig
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

    def as_array(self) -> np.ndarray:
        """(mu_s, mu_c, r)."""
        return np.array([self.mu_s, self.mu_c, self.r])


def draw_friction(
    config: Config, options: EpisodeOptions, material: str, rng: np.random.Generator
) -> Friction:
    """The material's friction, with what the options fix.

    Raises:
        ValueError: The material is unknown, or mu_s would be below mu_c.
    """
    names = sorted(config.materials)
    drawn = names[rng.integers(len(names))]  # drawn always, so that options do not shift later draws
    name = options.material or material
    if name == "random":
        name = drawn
    if name not in config.materials:
        raise ValueError(unknown("material", name, ["random", *names]))
    mu_s, mu_c = (options.choose(field, config.materials[name]) for field in ("mu_s", "mu_c"))
    if mu_s < mu_c:
        raise ValueError(f"mu_s = {mu_s:g} must be at least mu_c = {mu_c:g} (material {name!r})")
    return Friction(mu_s, mu_c, config.contact.radius if options.r is None else options.r)


def make_box(config: Config, options: EpisodeOptions, task: TaskConfig, rng: np.random.Generator) -> Box:
    """The object of the configuration, with what the task draws and the options fix."""
    default = config.object
    mass = default.mass
    if isinstance(task, HoldConfig):
        mass = rng.uniform(*task.mass_range)
    if options.object_mass is not None:
        mass = options.object_mass
    size = default.size if options.object_size is None else options.object_size
    inertia = default.inertia or mass * (size[0] ** 2 + size[2] ** 2) / 12.0
    return Box(
        size=size,
        com_offset=options.choose("com_offset", default),
        grasp_offset=default.grasp_offset,
        mass=float(mass),
        inertia=float(inertia),
    )
