"""Guesses what the columns of a file are: by their names, and units and signs by the size of their values."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records.cells import numbers, times
from estimator.records.proposal import Proposal, Proposed
from estimator.records.record import Array
from estimator.records.sources import Source, read_sources
from estimator.records.units import COP, REQUIRED, TILT, TIME, VELOCITY_TIME, unit_in, units_of

_END = r"[ _.]?(?P<side>[0-9lr]|left|right)?(?P<unit>[ _]?[\[(].*[\])])?$"


def _axis(words: str, letters: str, axis: str) -> str:
    """Matches a name that ends as words and an axis, or letters and an axis: force.x, Fx, f_x."""
    return rf"(?:(?:{words})[ _.]?|(?<![a-z])(?:{letters})[ _]?){axis}{_END}"


_NAMES: dict[str, tuple[str, ...]] = {
    TIME: (rf"(?<![a-z])(t|time|timestamp|stamp|zeit){_END}",),
    "f_x": (_axis("force|kraft", "f", "x"),),
    "f_y": (_axis("force|kraft", "f", "y"),),
    "f_n": (
        rf"(normal[ _]?(force)?|pressure[ _]?force|(?<![a-z])f_?n){_END}",
        _axis("force|kraft", "f", "z"),
    ),
    "tau": (rf"(?<![a-z])(tau|torsion){_END}", _axis("torque|moment|tau", "t|m", "z")),
    "tau_x": (_axis("torque|moment|tau", "t|m", "x"),),
    "tau_y": (_axis("torque|moment|tau", "t|m", "y"),),
    "v_x": (_axis("linear|velocity|slip|speed|vel", "v", "x"),),
    "v_y": (_axis("linear|velocity|slip|speed|vel", "v", "y"),),
    "omega": (
        rf"(?<![a-z])(omega|spin|slip[ _]rate|rotation[ _]rate){_END}",
        _axis("angular|omega|gyro", "w|omega", "z"),
    ),
    "cop_x": (_axis("cop", "cop", "x"),),
    "cop_y": (_axis("cop", "cop", "y"),),
    "grip": (rf"(grip(per)?|motor)[ _.]?(force|load|effort){_END}",),
    **{key: (rf"{key}$",) for key in ("true_mu_s", "true_mu_c", "true_r")},
}
_POSITIONS = {
    "v_x": (_axis("pos|position|displacement|disp", "p|d|s", "x"), rf"(?:^|/)x{_END}"),
    "v_y": (_axis("pos|position|displacement|disp", "p|d|s", "y"), rf"(?:^|/)y{_END}"),
    "omega": (rf"(?<![a-z])(angle|theta|yaw|phi){_END}",),
}
_PERIOD = 4e-5, 0.105
"""Sample periods of sensors [s]."""
_SIZES: dict[str, tuple[tuple[str, float], ...]] = {
    **dict.fromkeys(("f_x", "f_y", "f_n", "grip"), (("N", 300.0), ("mN", np.inf))),
    **dict.fromkeys(("tau", "tau_x", "tau_y"), (("N m", 0.1), ("N mm", np.inf))),
    **dict.fromkeys(("v_x", "v_y"), (("m/s", 2.0), ("mm/s", 2e3), ("um/s", np.inf))),
    "omega": (("rad/s", 60.0), ("deg/s", np.inf)),
    **dict.fromkeys(("cop_x", "cop_y", "true_r"), (("m", 0.05), ("mm", np.inf))),
    **dict.fromkeys(("true_mu_s", "true_mu_c"), (("-", np.inf),)),
}
"""Key -> units, and up to which largest value each is meant; of a torque it is that over the force."""
_SPANS = {
    **dict.fromkeys(("v_x", "v_y"), (("m", 0.3), ("mm", 300.0), ("um", np.inf))),
    "omega": (("rad", 30.0), ("deg", np.inf)),
}
"""The same of displacements."""
_TYPICAL = 0.98
"""Quantile that is taken for the largest value."""


def propose(path: Path) -> Proposal:
    """Looks at all columns of a file.

    Args:
        path: As `load` takes it.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It cannot be read.
        ModuleNotFoundError: An extra is not installed.
    """
    columns = [each for source in read_sources(path, None) for each in _numeric(source)]
    found = {key: _named(columns, patterns) for key, patterns in _NAMES.items()}
    places = [key for key in _POSITIONS if not found[key]]
    taken = {column.name for those in found.values() for _, column in those}
    free = [column for column in columns if column.name not in taken]
    found |= {key: _named(free, _POSITIONS[key]) for key in places}
    sides = sorted(({side for side, _ in found["f_x"]} & {side for side, _ in found["f_n"]}) - {""})
    fingers = {}
    for side in sides if len(sides) > 1 else [""]:
        chosen = {key: _of_side(those, side) for key, those in found.items() if those}
        for pair in (TILT, COP):
            if not set(pair) <= set(chosen) or (pair is COP and TILT[0] in chosen):
                chosen = {key: column for key, column in chosen.items() if key not in pair}
        name = {"l": "left", "r": "right"}.get(side, f"finger_{side}" if side else "")
        fingers[name] = [*_clocks(columns, chosen), *_finger(chosen, places)]
    used = {each.column for those in fingers.values() for each in those}
    there = [{each.key for each in those} for those in fingers.values()]
    missing = [key for key in REQUIRED if not all(key in keys for keys in there)]
    return Proposal(fingers, missing, [column.name for column in columns if column.name not in used])


@dataclass(frozen=True)
class _Column:
    """A column of numbers, and the time of its table."""

    name: str
    values: Array
    said: str
    dated: bool
    table: Source


def _numeric(source: Source) -> list[_Column]:
    found = []
    for name in source.frame.columns:
        cells = source.frame[name]
        try:
            dated = times(cells, source.comma)
            values = numbers(cells, source.comma) if dated is None else dated
        except (ValueError, TypeError, OverflowError):
            continue
        if np.isfinite(values).any():
            said = source.units.get(name, "") or (re.findall(r"[\[(]([^\[\]()]*)[\])]$", name) or [""])[0]
            found.append(_Column(name, values, said, dated is not None, source))
    return found


def _named(columns: Sequence[_Column], patterns: Sequence[str]) -> list[tuple[str, _Column]]:
    """Side of the finger, and column, of those that match the first pattern that any does."""
    for pattern in patterns:
        found = []
        for column in columns:
            name = _spoken(column)
            if match := re.search(pattern, name):
                before = _SIDE.findall(name)
                side = match.groupdict().get("side") or (
                    before[0].replace("finger", "").strip("_") if before else ""
                )
                found.append((side[:1], column))
        if found:
            return found
    return []


_SIDE = re.compile(r"(?<![a-z0-9])(left|right|[lr]|finger_?[0-9])(?![a-z0-9])")
_ROWS = {
    6: ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z"),
    3: ("v_x", "v_y", "omega"),
}
"""Number of columns of a wrench and of a slip -> what each is."""


def _spoken(column: _Column) -> str:
    """A name as it is compared: names[of] elements as .of, columns of a wrench as those of its message."""
    name = column.name.lower()
    if (match := re.fullmatch(r"(.*?(wrench|ft|force_?torque|slip|twist))\[(\d)\]", name)) is not None:
        count = sum(each.lower().startswith(f"{match[1]}[") for each in column.table.names)
        wrench = match[2] not in ("slip", "twist")
        if count == (6 if wrench else 3):
            return f"{match[1]}.{_ROWS[count][int(match[3])]}"
    return re.sub(r"\[([a-z]\w*)\]$", r".\1", name) if "/" in name else name


def _of_side(found: Sequence[tuple[str, _Column]], side: str) -> _Column:
    """The first column of a finger, or else the first of none."""
    own = [column for each, column in found if each == side] or [c for each, c in found if not each]
    return own[0] if own else found[0][1]


def _clocks(columns: Sequence[_Column], chosen: dict[str, _Column]) -> list[Proposed]:
    """The time of the forces, and that of the velocities where it is in another table."""
    chosen.pop(TIME, None)
    tables: list[tuple[str, Source]] = []
    for key, of in ((TIME, WRENCH), (VELOCITY_TIME, TWIST)):
        table = next((chosen[each].table for each in of if each in chosen), None)
        if table is not None and all(table is not other for _, other in tables):
            tables.append((key, table))
    found = []
    for key, table in tables:
        clocks = _named([column for column in columns if column.table is table], _NAMES[TIME])
        exact = [column for _, column in clocks if column.name == TIME]
        for column in (exact or [column for _, column in clocks])[:1]:
            step = np.diff(column.values[np.isfinite(column.values)])
            typical = float(np.median(step)) if len(step) else 1.0
            unit, why = unit_in(key, column.said), "said"
            if unit is None:
                fits = [u for u, k in units_of(key).items() if _PERIOD[0] <= k * typical <= _PERIOD[1]]
                unit, why = (fits or ["s"])[0], f"guessed: samples are {typical:.4g} apart"
            if column.dated:
                unit, why = "", "a date or duration"
            factor = units_of(key)[unit] if unit else 1.0
            found.append(Proposed(key, column.name, unit, 1, False, why, column.values * factor))
    return found


def _finger(chosen: Mapping[str, _Column], places: Sequence[str]) -> list[Proposed]:
    """The proposals of one finger; channels of a kind share a unit, and that of torques depends on forces."""
    found, force, shared = [], 1.0, {}
    for key, column in chosen.items():
        position, values = key in places, column.values
        kind = (_SPANS if position else _SIZES)[key]
        sizes = [
            _size(chosen[each].values, position)
            for each in chosen
            if (_SPANS if each in places else _SIZES)[each] is kind
        ]
        size = max(sizes) / (force if "N m" in dict(kind) else 1.0)
        unit, why = unit_in(key, column.said, position), "said"
        if unit is None:
            unit = shared.setdefault(id(kind), next(unit for unit, most in kind if size <= most))
            why = f"guessed: {'spans' if position else 'reaches'} {_size(values, position):.3g}"
        values = values * units_of(key, position)[unit]
        if key == "f_n":
            force = max(_size(values, False), 0.1)
        sign = -1 if key in ("f_n", "grip") and np.nanmean(values) < 0.0 else 1
        found.append(Proposed(key, column.name, unit, sign, position, why, sign * values))
    return found


def _size(values: Array, position: bool) -> float:
    """Largest value of a column without its peaks, or its span."""
    there = values[np.isfinite(values)]
    return float(np.ptp(there) if position else np.quantile(np.abs(there), _TYPICAL))
