"""Joins parameters, state and scratch into the type of a record, and generates functions over their fields.

What a field is follows from the part that declares it: no list of names stands elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from estimator._numba.memory import words
from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate


def joined(*parts: np.dtype) -> np.dtype:
    """The type of a record with the fields of all parts, in their order."""
    return np.dtype([field for part in parts for field in part.descr])


def elements(*parts: np.dtype) -> list[str]:
    """Every number of the parts as it is written behind a record's name: "normal", "z[0]", "z[1]"."""
    found = []
    for part in parts:
        for name in part.names or ():
            places = [f"[{', '.join(map(str, index))}]" for index in np.ndindex(part[name].shape)]
            found += [f"{name}{place.removesuffix('[]')}" for place in places]
    return found


def comparison(name: str, parts: tuple[np.dtype, ...], file: str, doc: str) -> Any:
    """Generate a compiled function (first, second) -> bool: whether two records agree in all bits of parts.

    The parts hold 8-byte numbers, and the records begin with them. `file` is `__file__` of the module that
    declares them.
    """
    count = len(elements(*parts))
    body = [
        f"one, two, differ = words(first, {count}), words(second, {count}), 0",
        f"for k in range({count}):",
        "    differ += one[k] != two[k]",
        "return differ == 0",
    ]
    return generate(name, ("first", "second"), body, {"words": words}, compiled, file, doc)


def transfer(name: str, parts: tuple[np.dtype, ...], file: str, doc: str) -> Any:
    """Generate a compiled function (source, target) that copies all fields of parts, see `comparison`."""
    body = [f"target.{each} = source.{each}" for each in elements(*parts)]
    return generate(name, ("source", "target"), body, {}, compiled, file, doc)


def reset(name: str, parts: tuple[np.dtype, ...], starts: Mapping[str, str], file: str, doc: str) -> Any:
    """Generate a compiled function (record) that sets all fields of parts, see `comparison`.

    `starts` maps an element, as in `elements`, to an expression of `record`; the others become 0.
    """
    body = [f"record.{each} = {starts.get(each, '0')}" for each in elements(*parts)]
    return generate(name, ("record",), body, {}, compiled, file, doc)
