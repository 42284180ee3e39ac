"""Declares the entries of infos in tables, holds them for all environments, and returns them to callers.

The numbers of an environment are one row of a plain array, vectors of three first: the row is also a table of
three columns. A structured array would be slower: numpy copies its records field by field.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate
from slipgym.envs.readings import of_state, row_writer


class Info(NamedTuple):
    """One entry of an info."""

    name: str
    shape: tuple[int, ...]
    unit: str
    meaning: str
    read: str
    """Expression for environment i in terms of the arguments of `write_infos`; {0} and {1} are replaced by an
    element's indices."""

    @property
    def reads(self) -> list[str]:
        """An expression for every element, in C order."""
        return [self.read.format(*index) for index in product(*map(range, self.shape))]


NUMBERS = (
    Info("true", (3,), "-, -, m", "true (mu_s, mu_c, r) now, mean of both fingers", "ground_truth[i, {0}]"),
    Info("true_per_finger", (2, 3), "-, -, m", "true (mu_s, mu_c, r) of each finger now",
         "episodes[i].present_friction[{0}, {1}]"),
    Info("estimated", (3,), "-, -, m", "estimated (mu_s, mu_c, r), mean of both fingers",
         "estimated[i, {0}]"),
    Info("estimated_per_finger", (2, 3), "-, -, m", "estimated (mu_s, mu_c, r) of each finger",
         "per_finger[i, {0}, {1}]"),
    Info("slip", (3,), "m, m, rad", "true slip displacement (x, y, theta) in the pad frame since the grasp",
         "worlds[i].slip[{0}]"),
    Info("slip_twist", (3,), "m/s, m/s, rad/s", "true slip velocity (v_x, v_y, omega) at the pad centre",
         "worlds[i].slip_twist[{0}]"),
    Info("contact_wrench", (2, 3), "N, N, N m", "true friction (f_x, f_y, tau) of either pad on the box",
         "pads[i, {0}].wrench[{1}]"),
    Info("grip_force", (2,), "N", "actuator force of each finger", "fingers[i, {0}].force"),
    Info("reference", (3,), "", "position, velocity and acceleration of the task's reference",
         "episodes[i].reference[{0}]"),
    Info("time", (), "s", "time since reset", "episodes[i].step * episodes[i].step_time"),
)  # fmt: skip
"""Entries that are numbers. The reward terms come on top."""

FLAGS = (
    Info("is_success", (), "", "whether the task is solved; see Episode End", "episodes[i].success"),
    Info("dropped", (), "", "whether the box was dropped", "episodes[i].dropped"),
    Info("violated", (), "", "whether success has become impossible", "episodes[i].violated"),
    Info("finished", (), "", "whether the episode has its full length, the task's own",
         "episodes[i].step >= episodes[i].steps"),
)  # fmt: skip
"""Entries that are true or false, in the order of a row."""

_EARLY = "episodes[i].dropped or episodes[i].ended"
"""Whether the episode has ended early: it follows the flags in a row."""

_LAYOUT = sorted(NUMBERS, key=lambda info: info.shape[-1:] != (3,))
"""`NUMBERS` in the order of a row."""
_SIZES = [math.prod(info.shape) for info in _LAYOUT]
_WIDTH = -(-sum(_SIZES) // 3) * 3
_STOPS = np.cumsum(_SIZES).tolist()
PARTS = {
    info.name: slice(stop - size, stop) for info, stop, size in zip(_LAYOUT, _STOPS, _SIZES, strict=True)
}
"""Where the entries of `NUMBERS` are in a row."""
_FLAG_NAMES = [info.name for info in FLAGS]
INFO_NAMES = (*(info.name for info in NUMBERS), *_FLAG_NAMES, "reward_terms")
"""Keys of an info, in order."""
_ESTIMATES = "estimated", "estimated_per_finger"
"""Entries that an environment without estimators does not have."""


def _numbers(estimating: bool) -> tuple[Info, ...]:
    """Those of `NUMBERS` that an environment has."""
    return tuple(info for info in NUMBERS if estimating or info.name not in _ESTIMATES)


class InfoBuffer(NamedTuple):
    """Infos of n environments."""

    numbers: np.ndarray
    """See `NUMBERS`, (n, m)."""
    flags: np.ndarray
    """See `FLAGS`; then whether the episode ended early, (n, 5) bool."""
    terms: np.ndarray
    """Reward terms of the last step, summed over its control steps, (n, k)."""

    @classmethod
    def zeros(cls, n: int, terms: int) -> InfoBuffer:
        """Make a buffer for n environments and a number of reward terms."""
        flags = np.zeros((n, len(FLAGS) + 1), dtype=bool)
        return cls(np.zeros((n, _WIDTH)), flags, np.zeros((n, terms)))

    def empty_like(self) -> InfoBuffer:
        """Return another buffer of the same shapes, with undefined contents."""
        return InfoBuffer(*map(np.empty_like, self))

    def every(self, terms: Sequence[str], estimating: bool, mask: np.ndarray | None = None) -> dict[str, Any]:
        """Infos of all environments as `gymnasium.vector.VectorEnv` returns them: views, with masks beside.

        Args:
            terms: Names of the reward terms.
            estimating: Whether there are estimates.
            mask: Environments whose infos are valid, (n,) bool; None: all.
        """
        numbers, flags, values = self
        infos: dict[str, Any] = {
            info.name: numbers[:, PARTS[info.name]].reshape(-1, *info.shape) for info in _numbers(estimating)
        }
        infos |= {name: flags[:, k] for k, name in enumerate(_FLAG_NAMES)}
        scaled = {name: values[:, k] for k, name in enumerate(terms)}
        masks = np.ones((len(infos) + 1 + len(scaled), len(numbers)), dtype=bool)
        if mask is not None:
            masks[:] = mask
        left = iter(masks)
        return _with_masks({**infos, "reward_terms": _with_masks(scaled, left)}, left)

    def some(self, rows: np.ndarray, terms: Sequence[str], estimating: bool) -> dict[str, Any]:
        """Copies of the infos of some environments (m,), zero elsewhere, with masks; empty for no rows."""
        if not rows.size:
            return {}
        n = len(self.flags)
        copy, mask = InfoBuffer.zeros(n, self.terms.shape[1]), np.zeros(n, dtype=bool)
        mask[rows] = True
        for mine, other in zip(copy, self, strict=True):
            mine[rows] = other[rows]
        return copy.every(terms, estimating, mask)


def _with_masks(infos: dict[str, Any], left: Iterator[np.ndarray]) -> dict[str, Any]:
    """Add a mask to each info that says which environments have it, as Gymnasium requires."""
    return {**infos, **{f"_{name}": next(left) for name in infos}}


_BEFORE = of_state("worlds", "pads", "fingers", "episodes", "ground_truth", "estimated", "per_finger")
_write_numbers = row_writer(
    "_write_numbers",
    [read for info in _LAYOUT for read in info.reads],
    ("state",),
    __file__,
    "Write `NUMBERS` of environment i, as they are in a row.",
    _BEFORE,
)
_write_flags = row_writer(
    "_write_flags",
    [*(info.read for info in FLAGS), _EARLY],
    ("state",),
    __file__,
    "Write `FLAGS` of environment i, and whether its episode has ended.",
    _BEFORE,
)


@compiled
def write_infos(state, numbers, flags, i):
    """Write the infos of environment i of a `BatchState` but the reward terms to arrays of `InfoBuffer`."""
    _write_numbers(numbers[i], i, state)
    _write_flags(flags[i], i, state)


InfoReader: TypeAlias = Callable[[], tuple[dict[str, Any], float, bool, bool]]
"""Copies the infos of the first environment.

Returns:
    The info, the sum of its reward terms, whether the episode has ended early, and whether it has its full
    length.
"""


def info_reader(buffer: InfoBuffer, terms: Sequence[str], estimating: bool) -> InfoReader:
    """Return the `InfoReader` of a buffer, whose arrays must stay the same.

    The arrays of an info share memory that only they use. PyBullet's step leaves nothing in the processor's
    cache: few calls matter more here than short ones. The reader's source is therefore generated, without a
    loop.
    """
    numbers, (flags, *_), (values, *_) = buffer.numbers, buffer.flags, buffer.terms
    made = _reader(tuple(terms), estimating)
    return partial(made, numbers.reshape(-1, 3).copy, numbers.item, flags.tolist, values.tolist)


@cache
def _reader(terms: tuple[str, ...], estimating: bool) -> Callable[..., Any]:
    """A function (rows, number, flags, terms) that makes an info of what these four functions return."""
    flags, values = [f"flag_{k}" for k in range(len(FLAGS))], [f"term_{k}" for k in range(len(terms))]
    reads = {info.name: _read(info) for info in _numbers(estimating)}
    reads |= {info.name: flag for info, flag in zip(FLAGS, flags, strict=True)}
    reads["reward_terms"] = _display(dict(zip(terms, values, strict=True)))
    order = [name for name in INFO_NAMES if name in reads]
    body = [
        "table, values = rows(), terms()",
        f"[{', '.join(values)}] = values",
        f"{', '.join(flags)}, early = flags()",
        f"return {_display({name: reads[name] for name in order})}, sum(values), early, {reads['finished']}",
    ]
    arguments = "rows", "number", "flags", "terms"
    return generate("_take", arguments, body, {}, lambda made: made, __file__, "See `InfoReader`.")


def _read(info: Info) -> str:
    """Expression for an entry of `NUMBERS` in terms of a copy of the row, which has three columns."""
    row, column = divmod(PARTS[info.name].start, 3)
    if not info.shape:
        return f"number({PARTS[info.name].start})"
    if len(info.shape) == 2:
        return f"table[{row}:{row + info.shape[0]}]"
    return f"table[{row}]" if info.shape == (3,) else f"table[{row}, {column}:{column + info.shape[0]}]"


def _display(entries: dict[str, str]) -> str:
    """Source text of a dictionary: keys, and expressions of values."""
    return "{" + ", ".join(f"{name!r}: {read}" for name, read in entries.items()) + "}"
