"""Samples the randomized values of an episode, schedules its disturbances, and keeps both for infos."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import compress
from typing import Any

import numpy as np

from slipgym.config import Config, Randomization, Ranges, TaskConfig
from slipgym.config.distribution import Distribution
from slipgym.config.disturbances import Shake
from slipgym.config.errors import NEEDS_TILT, unknown
from slipgym.config.pad import EFFECTS
from slipgym.envs.sampling_kernels import (
    BLENDED,
    DISTURBANCE,
    GATED,
    KINDS,
    NUMBER,
    PLAIN,
    SPARE,
    sample_values,
    schedule,
)
from slipgym.envs.values import FIXED_BY, FRICTION, NAMES, PLACES, SIZE, VALUES, flat, labels, nominal_values
from slipgym.tasks.options import EpisodeOptions

UNIFORMS = 8
"""Number of uniform random numbers per disturbance, the most that any kind needs."""


class Randomizer:
    """Samples the randomized values of the episodes of a task, given by its key.

    Attributes:
        active: Whether anything is sampled.
        soft: Whether pads may be soft or uneven.
        variants: Configurations with the pressure profiles that an episode may have, by their names.
        drawn: Names of the fields of `VALUES` that are sampled.
        kinds: Kinds of the disturbances that may happen.
        count: Number of uniform random numbers per episode.

    Raises:
        ValueError: A material is unknown, the largest contact radius does not fit on the pads, or the wrist
            shakes out of the contact plane without `physics.tilt`.
    """

    def __init__(self, config: Config, settings: TaskConfig, task: str, randomization: Randomization) -> None:
        self._ranges = ranges = randomization.of(task)
        shakes = ((j, each) for j, each in enumerate(ranges.disturbances) if isinstance(each, Shake))
        self._tilting = [(j, each) for j, each in shakes if each.roll or each.sway]
        if self._tilting and not config.physics.tilt:
            raise ValueError(f"randomization: shake in roll or sway {NEEDS_TILT}")
        for material in ranges.materials or ():
            if material not in config.materials:
                raise ValueError(f"randomization: {unknown('material', material, config.materials)}")
        self.active = ranges != Ranges()
        self.soft = any(self.draws(name) for name in EFFECTS)
        pressures = dict.fromkeys((config.contact.pressure, *(ranges.pressure or ())))
        contacts = {each: config.contact.model_copy(update={"pressure": each}) for each in pressures}
        self.variants = {each: config.model_copy(update={"contact": own}) for each, own in contacts.items()}
        self._nominal = nominal_values(config)
        self.drawn = tuple(name for name in VALUES.names or () if self.draws(name))
        self.kinds = tuple(disturbance.kind for disturbance in ranges.disturbances)
        self._tabulate(sorted(config.materials))
        self.drawn += ("load_exponent",) if ranges.friction_by_area else ()
        if ranges.cop_offset is not None:
            farthest = max(map(abs, ranges.cop_offset.ends))
            config.check_cop_offset("randomization.cop_offset: the farthest", [(farthest, farthest)])
        pad = config.gripper.pad_radius
        most = settings.radius_range[1] if settings.radius_range else settings.radius
        for variant in self.variants.values() if self.active else ():
            r = self.most("radius_scale") * self.most("finger_radius") * (most or variant.contact_radius)
            if r > pad * (1.0 + 1e-9):
                limit = f"must not exceed gripper.pad_radius = {pad:g} m"
                raise ValueError(f"randomization: the largest radius r = {r:g} m {limit}")
            variant.check_patch("randomization: the largest radius r", r)

    def draws(self, name: str) -> bool:
        """Whether a field of `VALUES` is randomized."""
        return getattr(self._ranges, name) is not None

    def most(self, name: str) -> float:
        """Largest possible value of a field of `VALUES` that has a nominal one."""
        field, nominal = getattr(self._ranges, name), self._nominal[name].max().item()
        return max(nominal, field.ends[1]) if field else nominal

    def sample(self, shares: np.ndarray, scale: float) -> np.ndarray:
        """Map uniform random numbers to the values of episodes, VALUES (m,).

        Args:
            shares: In [0, 1), (m, `count`).
            scale: 0 for the configuration, 1 for the full ranges. Numbers are interpolated; names and
                disturbances are sampled with this probability.
        """
        values = np.empty(len(shares), VALUES)
        sample_values(shares, self._numbers, self._choices, scale, flat(values))
        if self._ranges.friction_by_area:  # what is sampled of the exponents lies on n = 1 - 2 b
            sampled = values["radius_exponent"] - (1.0 - scale) * self._nominal["radius_exponent"]
            values["load_exponent"] = (1.0 - scale) * self._nominal["load_exponent"] + scale - 2.0 * sampled
        return values

    def schedule(
        self, shares: np.ndarray, scale: float, rows: np.ndarray, episodes: np.ndarray
    ) -> np.ndarray:
        """Write disturbances into some rows (m,) of EPISODE (n,), which tasks have started.

        Shares and scale are those of `sample`.

        Returns:
            Whether each disturbance happens, (m, d) bool.
        """
        happens = np.zeros((len(rows), len(self.kinds)), dtype=bool)
        if self.kinds:
            tables = self._disturbances, self._distributions, self._choices
            schedule(shares, *tables, scale, rows, episodes, happens)
        for j, shake in self._tilting:
            for k in np.flatnonzero(happens[:, j]).tolist():
                share = shares[k, self._disturbances["at"][j] + UNIFORMS].item()
                episodes["tilt_shakes"][rows[k]] = _tilt_shake(shake, share)
        return happens

    def _tabulate(self, materials: Sequence[str]) -> None:
        """Make the tables of `slipgym.envs.sampling_kernels`."""
        choices: list[float] = []
        indices = dict(zip(NAMES, (materials, list(self.variants)), strict=True))
        numbers = np.zeros(SIZE, NUMBER)
        count, numbers["at"], numbers["nominal"] = 0, -1, flat(self._nominal)[0]
        for name in self.drawn:
            field, own = getattr(self._ranges, name), numbers[PLACES[name]]
            own["rule"] = PLAIN if name in FRICTION else GATED if name in NAMES else BLENDED
            if name in NAMES:
                field = Distribution(choices=tuple(float(indices[name].index(each)) for each in field))
            for number in own:
                _describe(number, field, choices)
            spare = SPARE.get(name) in self.drawn
            own["at"] = numbers[PLACES[SPARE[name]]]["at"] + 1 if spare else count + np.arange(len(own))
            count += 0 if spare else max(2, len(own))  # a single number leaves one for its gate
        disturbances = np.zeros(len(self.kinds), DISTURBANCE)
        distributions = np.zeros((len(self.kinds), max(map(len, KINDS.values()))), NUMBER)
        for j, disturbance in enumerate(self._ranges.disturbances):
            disturbances[j] = count, list(KINDS).index(disturbance.kind), disturbance.probability
            count += 1 + UNIFORMS
            for number, name in zip(distributions[j], KINDS[disturbance.kind], strict=False):
                _describe(number, getattr(disturbance, name), choices)
        self._numbers, self._disturbances, self._distributions = numbers, disturbances, distributions
        self._choices, self.count = np.array(choices), count


def _describe(number: np.void, field: Distribution, choices: list[float]) -> None:
    """Enter a distribution into a NUMBER record, and its choices into their list."""
    for name, value in zip(("kind", "low", "high", "span"), field.parameters, strict=True):
        number[name] = value
    number["first"] = len(choices)
    choices.extend(field.choices or ())
    number["last"] = len(choices)


def _tilt_shake(shake: Shake, share: float) -> np.ndarray:
    """Oscillation in roll and along the grip axis, (2, 3), from the last of its random numbers."""
    more = np.random.default_rng(int(share * 2.0**53)).random(6).tolist()
    sizes = [0.0 if each is None else each.at(more[k]) for k, each in enumerate((shake.roll, shake.sway))]
    omega = [math.tau * shake.frequency.at(each) for each in more[2:4]]
    return np.column_stack((sizes, omega, [math.tau * each for each in more[4:6]]))


FIRST = ("mu_s", "mu_c", "mass")
"""What comes before the sampled values: friction and mass of the episode, sampled or not."""
WHOLE = ("slip_latency",)
"""Values that are whole numbers."""
TEXTS = ("pressure", "disturbances")
"""What comes after the sampled values."""


class Drawn:
    """Values sampled for the episodes of n environments, without those that an option fixes."""

    def __init__(self, randomizer: Randomizer, n: int) -> None:
        self._randomizer, self._n = randomizer, n
        self._pressures = list(randomizer.variants)
        fields = [name for name in randomizer.drawn if name not in FRICTION + NAMES]
        own = [(name, label) for name in fields for label in labels(name)]
        self._names = [*FIRST, *(label for _, label in own)]
        self._fixed_by = [*(None for _ in FIRST), *(FIXED_BY.get(name) for name, _ in own)]
        self._places = [place for name in fields for place in range(SIZE)[PLACES[name]]]
        self._numbers = np.zeros((n, len(self._names)))
        self._known = np.zeros((n, len(self._names)), dtype=bool)
        self._texts = np.full((len(TEXTS), n), None, dtype=object)

    def reported(self, options: EpisodeOptions) -> list[bool]:
        """Whether each number is reported for episodes with some reset options."""
        return [fixed is None or getattr(options, fixed) is None for fixed in self._fixed_by]

    def keep(
        self,
        rows: np.ndarray,
        known: list[bool],
        starts: np.ndarray,
        values: np.ndarray,
        happened: np.ndarray,
    ) -> None:
        """Keep what was sampled for episodes (m,) that begin, unless nothing is randomized.

        `known` is from `reported`, of the options of all of them; `happened` says whether each disturbance
        happens, (m, d).
        """
        if not self._randomizer.active:
            return
        first = starts["friction"][:, :2], starts["mass"]
        self._numbers[rows] = np.column_stack((*first, flat(values)[:, self._places]))
        self._known[rows] = known
        self._texts[0, rows] = [self._pressures[place] for place in starts["pressure"].tolist()]
        kinds = self._randomizer.kinds
        self._texts[1, rows] = [", ".join(compress(kinds, flags)) for flags in happened.tolist()]

    def one(self, i: int) -> dict[str, Any]:
        """Values sampled for environment i, JSON-like; empty without randomization."""
        numbers = dict(compress(zip(self._names, self._numbers[i].tolist(), strict=True), self._known[i]))
        if not numbers:
            return {}
        numbers |= {name: round(numbers[name]) for name in WHOLE if name in numbers}
        return numbers | dict(zip(TEXTS, self._texts[:, i].tolist(), strict=True))

    def some(self, rows: np.ndarray) -> dict[str, Any]:
        """Infos of some environments (m,) as `gymnasium.vector.VectorEnv` returns them; may be empty."""
        columns = np.flatnonzero(self._known[rows].any(axis=0))
        if not columns.size:
            return {}
        masks = np.zeros((len(columns) + len(TEXTS) + 1, self._n), dtype=bool)
        masks[: len(columns), rows] = self._known[np.ix_(rows, columns)].T
        masks[len(columns) :, rows] = True
        numbers = np.where(masks[: len(columns)], self._numbers.T[columns], 0.0)
        texts = np.full_like(self._texts, None)
        texts[:, rows] = self._texts[:, rows]
        infos: dict[str, Any] = dict(
            zip([*(self._names[k] for k in columns), *TEXTS], [*numbers, *texts], strict=True)
        )
        infos |= {name: infos[name].astype(np.int64) for name in WHOLE if name in infos}
        infos |= {f"_{name}": mask for name, mask in zip(list(infos), masks, strict=False)}
        return {"drawn": infos, "_drawn": masks[-1]}
