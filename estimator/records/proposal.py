"""Proposes a mapping for a file of unknown columns: by their names, and units and signs by magnitudes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.cells import numbers, times
from estimator.records.checks import OPPOSITE, correlation, likely_time
from estimator.records.extras import extra
from estimator.records.record import Array
from estimator.records.sources import read_columns
from estimator.records.units import (
    FINGERS,
    POSITIONS,
    REQUIRED,
    TIME,
    TRUTH,
    UNITS,
    VELOCITY_TIME,
    unit_of,
    units_of,
    without_unit,
)

_AXES = {"x": ("x", "0"), "y": ("y", "1"), "z": ("z", "2")}
_WORDS = {
    "f": "f|force|ft|wrench|forces|load",
    "m": "m|t|torque|tau|moment|torques",
    "v": "v|vel|velocity|slip|linear|slip_velocity|slip_vel|twist",
    "w": "w|omega|angular|rate|slip_rate|rot|rotation",
}
_WHOLE = {
    TIME: r"((ft|f|force|wrench|header)_)?"
    r"(secs?|seconds|ms|(t|time|stamp|time_?stamp|elapsed)(_?([mun]s|s|secs?|seconds))?)",
    VELOCITY_TIME: r"velocity_t|(slip|vel|velocity|twist|v)_?(t|time|stamp)(_[mun]?s)?",
    "f_n": r"f_?n|normal(_force)?|pressure_force|grip(_force)?",
    "tau": r"tau(_?[nz])?|mz|tz|torsion|(ft|wrench)\[5\]",
    "omega": r"omega(_?[nz])?|wz|yaw_?rate|slip_?(rate|rot|omega)|slip\[2\]",
    "cop_x": r"cop_?x|cop\[0\]",
    "cop_y": r"cop_?y|cop\[1\]",
    "force": r"((grip(per)?|force)_?)*(cmd|command(ed)?|target|goal|setpoint|desired)(_?(grip(per)?|force))*",
    "true_mu_s": "true_mu_s|mu_s",
    "true_mu_c": "true_mu_c|mu_c|mu_k",
    "true_r": "true_r",
}
_COMPONENT = {
    "f_x": "fx", "f_y": "fy", "f_n": "fz", "tau_x": "mx", "tau_y": "my", "tau": "mz",
    "v_x": "vx", "v_y": "vy", "omega": "wz", "motion_x": "vx", "motion_y": "vy", "motion_omega": "wz",
}  # fmt: skip
_ROBOT = re.compile(r"(^|[./_])(arm|robot|wrist|tcp|eef?|end_effector|flange|tool|motion)([./_]|$)")
"""Names of what the robot does itself."""
_MOTION = {"motion_x": ("v_x", "f_x"), "motion_y": ("v_y", "f_y"), "motion_omega": ("omega", "tau")}
"""Motion of the object against the gripper -> what goes along with it."""
_PLACES = {
    "v_x": r"((pos|position|disp|displacement|p|s)[._]?)?(x|\[0\])",
    "v_y": r"((pos|position|disp|displacement|p|s)[._]?)?(y|\[1\])",
    "omega": r"angle|theta|phi|yaw|(pos|position)_?angle",
}
"""Columns that count displacement, by the velocity."""
_SPANS = {"v_x": 0.3, "v_y": 0.3, "omega": 30.0}
"""Longest likely way in a record [m, m, rad]."""
_SIDE = re.compile(
    r"(?<![a-z0-9\[])(left|right|l|r|finger_?[12]|[12])(?![a-z0-9\]])|(?<=[a-z_])[12]$", re.IGNORECASE
)
_UNIT = re.compile(r"\s*[\[(][^\[\]()]*[a-zA-Z%°µμ][^\[\]()]*[\])]$")
RATES = 20.0, 25_000.0
"""Likely sample rates [Hz]."""
LIKELY = {"f": 200.0, "arm": 0.08, "v": 1.5, "omega": 60.0}
"""Most that 99 % of a fingertip's readings are: force [N], torque over force [m], slip [m/s, rad/s]."""


@dataclass(frozen=True)
class Proposal:
    """One line of a mapping."""

    key: str
    column: str
    unit: str | None
    """None: it has one that slipgym does not know."""
    sign: int
    why: str
    """Reason for unit and sign."""
    position: bool
    """Whether it counts displacement."""
    values: Array
    """In SI units, by the likely one if its own is unknown, with the sign; NaN where a cell is empty."""


def propose_fingers(path: Path) -> tuple[dict[str, list[Proposal]], list[str]]:
    """Proposes what the columns of a file are, for each finger if the names of the forces say two.

    Returns:
        Name of the finger -> its proposals, in the order of `UNITS`, a single empty name if there is one
        finger; the columns that nothing was found for.

    Raises:
        FileNotFoundError, ValueError, ModuleNotFoundError: As `load`.
    """
    (frame, stated), found = read_columns(path), {}
    sides = {name: _side(name) for name in frame}
    for side in sorted({side for side in sides.values() if side}):
        names = {_SIDE.sub("", name).strip("_. "): name for name in frame if sides[name] in ("", side)}
        of_names = ({short: of[name] for short, name in names.items()} for of in (frame, stated))
        own = _proposed(*of_names)
        own = [replace(each, column=names[each.column]) for each in own]
        if {"f_x", "f_n"} <= {each.key for each in own if sides[each.column] == side}:
            found[f"finger_{side}" if side.isdigit() else side] = own
    if len(found) < 2:
        found = {"": _proposed(frame, stated)}
    used = {each.column for own in found.values() for each in own}
    return found, [name for name in frame if name not in used]


def _side(name: str) -> str:
    """left, right, 1 or 2, if a name has it."""
    match = _SIDE.search(name)
    side = match[0].lower().replace("finger", "").strip("_") if match else ""
    return {"l": "left", "r": "right"}.get(side, side)


def _proposed(frame: Mapping[str, Any], stated: Mapping[str, list[str]]) -> list[Proposal]:
    numeric: dict[str, tuple[Array, bool]] = {}
    for name, cells in frame.items():
        series = extra("pandas").Series(cells, name=name)
        for read in (times, numbers):
            try:
                values = read(series)
            except (ValueError, TypeError, OverflowError):
                continue
            if values is not None and np.isfinite(values).any():
                numeric[name] = values, read is times
                break
    chosen = _by_name({name: len(values) for name, (values, _) in numeric.items()})
    plain = {
        name: _UNIT.sub("", name).strip().lower().rpartition("/")[2]
        for name in numeric
        if name not in chosen.values()
    }
    places: dict[str, str] = {}  # velocity -> column of the displacement, where there is none of the velocity
    for key, pattern in _PLACES.items():
        hits = [name for name in plain if re.fullmatch(pattern, plain[name])]
        if key not in chosen and hits:
            places[key] = hits[0]
    found: dict[str, Proposal] = {}
    for key in (key for key in UNITS if key in chosen):
        values, dated = numeric[chosen[key]]
        alike = [numeric[chosen[other]][0] for other in chosen if UNITS[other] is UNITS[key]]
        said = stated[chosen[key]]
        unit, sign, why = ("s", 1, "dates") if dated else _unit(key, chosen[key], values, alike, found, said)
        values = sign * UNITS[key][unit] * values
        found[key] = _as_stated(
            Proposal(key, chosen[key], unit, sign, why, False, values), said * (not dated)
        )
    ways = {key: numeric[name][0] for key, name in places.items()}
    spans = {key: float(np.ptp(way[np.isfinite(way)])) for key, way in ways.items()}
    for key, name in places.items():
        units = units_of(key, position=True)
        span = max(spans[other] for other in places if POSITIONS[other] == POSITIONS[key])
        likely = [unit for unit, factor in units.items() if span * factor <= _SPANS[key]]
        unit = unit_of(key, stated[name], position=True) or (likely or list(units))[0]
        why = f"a way of up to {span * units[unit]:.3g} {next(iter(units))}"
        line = Proposal(key, name, unit, 1, why, True, units[unit] * ways[key])
        found[key] = _as_stated(line, stated[name])
    return list(found.values())


def _as_stated(line: Proposal, said: list[str]) -> Proposal:
    """A line without its unit, where the file states one that is unknown."""
    if said and unit_of(line.key, said, line.position) is None:
        return replace(line, unit=None, why=f"unknown unit {said[0]!r}: state `scale`, or `unit`")
    return line


def text_of_fingers(found: Mapping[str, list[Proposal]]) -> str:
    """The mapping of one finger, or of each of several, as YAML with the reason of each line as a comment."""
    lines = ["# Proposed by slipgym map: look at every line. docs/records.md lists keys, units and frames."]
    lines += [] if "" in found else [f"{FINGERS}:"]
    for finger, proposals in found.items():
        lines += [f"  {finger}:"] if finger else []
        own = []
        for each in proposals:
            sign, kind = ", sign: -1" if each.sign < 0 else "", "position" if each.position else "column"
            column = each.column.replace("'", "''")
            unit = f", unit: '{each.unit}'" if each.unit else ""
            own.append(f"{each.key}: {{{kind}: '{column}'{unit}{sign}}}  # {each.why}")
        given = {each.key for each in proposals}
        own += [f"# {key}: ?  nothing looks like it" for key in REQUIRED if key not in given]
        lines += ["    " * bool(finger) + line for line in own]
    return "\n".join([*lines, ""])


def _by_name(lengths: Mapping[str, int]) -> dict[str, str]:
    """Key -> column; the streams' times are those of as many values."""
    chosen: dict[str, str] = {}
    for key in UNITS:
        free = [name for name in lengths if name not in chosen.values()]
        hits = [(score, name) for name in free if (score := _score(key, name))]
        if hits:
            best = max(score for score, _ in hits)
            chosen[key] = min((name for score, name in hits if score == best), key=len)
    for time, first in ((TIME, "f_n"), (VELOCITY_TIME, "v_x")):
        if first in chosen:
            n = lengths[chosen[first]]
            clocks = [name for name in lengths if _score(TIME, name) and lengths[name] == n]
            if time in chosen and lengths[chosen[time]] != n:
                del chosen[time]
            if time not in chosen and clocks and clocks[0] not in chosen.values():
                chosen[time] = clocks[0]
    rows = [lengths[chosen[time]] for time in (TIME, VELOCITY_TIME) if time in chosen]
    if len(rows) == 2 and rows[0] == rows[1]:
        del chosen[VELOCITY_TIME]
    return {key: chosen[key] for key in UNITS if key in chosen}


def _score(key: str, name: str) -> int:
    """How well a name says that a column is what a key means: 4 its key, 3 whole, 2 its end, 1 an axis."""
    shorter = without_unit(key, name)
    return _said(key, name) or (_said(key, shorter[0]) if shorter else 0)


def _said(key: str, name: str) -> int:
    plain = _UNIT.sub("", name).strip().lower().replace(" ", "_").replace("-", "_")
    if plain == key:
        return 4
    if (key in _MOTION or key in POSITIONS) and (key in _MOTION) != bool(_ROBOT.search(plain)):
        return 0
    last = re.split(r"[./]", plain)[-1]
    if key in _WHOLE and re.fullmatch(_WHOLE[key], plain):
        return 3
    if key in _WHOLE and key not in TRUTH and re.fullmatch(_WHOLE[key], last):
        return 2
    if key in _COMPONENT:
        kind, axis = _COMPONENT[key]
        at = "|".join(_AXES[axis])
        if re.search(rf"(^|[./_])({_WORDS[kind]})([./_]?({axis})|\[({at})\])$", plain):
            return 1
    return int(key == "tau" and last in ("ft[3]", "wrench[3]"))  # of four columns


def _unit(
    key: str, name: str, values: Array, alike: list[Array], found: Mapping[str, Proposal], said: list[str]
) -> tuple[str, int, str]:
    """Unit, sign and their reason; the largest of the columns of a kind decides the unit of all."""
    shorter = None if _said(key, name) else without_unit(key, name)
    stated, units = unit_of(key, said) or (shorter[1] if shorter else None), UNITS[key]
    x = values[np.isfinite(values)]
    if key in (TIME, VELOCITY_TIME):
        step = float(np.median(np.abs(np.diff(np.unique(x))))) if len(x) > 1 else 0.0
        rates = {unit: 1.0 / (step * factor) for unit, factor in units.items()} if step else {}
        likely = likely_time(np.unique(x), units) if rates else []
        fast = [unit for unit, rate in rates.items() if RATES[0] <= rate <= RATES[1]]
        first, *others = [stated] if stated else likely or fast or ["s"]
        too = "".join(f"; {rates[unit]:.5g} Hz if it is in {unit}" for unit in others if unit in likely)
        return first, 1, f"{rates[first]:.5g} Hz{too}" if rates else "one time"
    size = max(float(np.nanpercentile(np.abs(each), 99)) for each in alike)
    most = LIKELY["omega"] if key.endswith("omega") else LIKELY["v"] if "m/s" in units else np.inf
    if "N" in units:
        most = LIKELY["f"]
    elif key.startswith("tau") and "f_n" in found:
        most = LIKELY["arm"] * float(np.nanpercentile(np.abs(found["f_n"].values), 99))
    fits = [unit for unit, factor in units.items() if size * factor <= most]
    unit = stated or (fits[0] if fits else next(iter(units)))
    sign, why = 1, "unit of the file" if stated else f"up to {size * units[unit]:.3g} {next(iter(units))}"
    pressed = x[np.abs(x) > 0.5 * np.max(np.abs(x))]
    if key == "f_n" and len(pressed) and float(np.median(pressed)) < 0.0:
        sign, why = -1, f"{why}; negative in contact"
    for other in _MOTION.get(key, ()):
        if other in found and correlation(values, found[other].values) < -OPPOSITE:
            return unit, -1, f"{why}; goes against {other}"
    return unit, sign, why


def plot(proposals: list[Proposal], path: Path) -> None:
    """Draws every proposed column over the time of its stream, as a png."""
    pyplot = extra("matplotlib.pyplot")
    shown = [each for each in proposals if each.key not in (TIME, VELOCITY_TIME)]
    clocks = {each.key: each.values for each in proposals if each.key in (TIME, VELOCITY_TIME)}
    rows = max(len(shown), 1)
    figure, axes = pyplot.subplots(rows, 1, sharex=True, figsize=(9, 1.3 * rows), squeeze=False)
    for ax, each in zip(axes[:, 0], shown, strict=False):
        t = next((t for t in clocks.values() if len(t) == len(each.values)), np.arange(len(each.values)))
        there = np.isfinite(each.values)
        ax.plot((t - np.nanmin(t))[there], each.values[there], linewidth=0.8)
        minus = "−" if each.sign < 0 else ""
        ax.set_title(f"{each.key} = {minus}{each.column}", loc="left", fontsize=9)
        ax.set_ylabel(f"[{next(iter(units_of(each.key, each.position)))}]")
    axes[-1, 0].set_xlabel("time [s]")
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
