"""The infos of one environment as `gymnasium.Env` returns them: the caller's own arrays, plain numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, TypeAlias

from slipgym._numba.generate import generate
from slipgym.envs.infos import FLAGS, INFO_NAMES, NUMBERS, PARTS, Info, InfoBuffer

InfoReader: TypeAlias = Callable[[], tuple[dict[str, Any], float, bool, bool]]
"""Copies the infos of the first environment.

Returns:
    The info, the sum of its reward terms, whether the episode has ended early, and whether it has its full
    length.
"""


def info_reader(buffer: InfoBuffer, terms: Sequence[str]) -> InfoReader:
    """Return the `InfoReader` of a buffer. The arrays of an info share memory that only they use.

    PyBullet's step leaves nothing in the processor's cache: few calls matter more here than short ones. The
    reader's source is therefore generated, without a loop.

    Args:
        buffer: The buffer; its arrays must stay the same.
        terms: Names of the reward terms.
    """
    numbers, (flags, *_), (values, *_) = buffer.numbers, buffer.flags, buffer.terms
    return partial(
        _reader(tuple(terms)), numbers.reshape(-1, 3).copy, numbers.item, flags.tolist, values.tolist
    )


@cache
def _reader(terms: tuple[str, ...]) -> Callable[..., Any]:
    """A function (rows, number, flags, terms) that makes an info of what these four functions return."""
    flags, values = [f"flag_{k}" for k in range(len(FLAGS))], [f"term_{k}" for k in range(len(terms))]
    reads = {info.name: _read(info) for info in NUMBERS}
    reads |= {info.name: flag for info, flag in zip(FLAGS, flags, strict=True)}
    reads["reward_terms"] = _display(dict(zip(terms, values, strict=True)))
    body = [
        "table, values = rows(), terms()",
        f"[{', '.join(values)}] = values",
        f"{', '.join(flags)}, early, full = flags()",
        f"return {_display({name: reads[name] for name in INFO_NAMES})}, sum(values), early, full",
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
