"""Proposes a mapping for a file of unknown columns: by their names, and units and signs by magnitudes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.cells import numbers, times
from estimator.records.extras import extra
from estimator.records.record import Array
from estimator.records.table import read_columns, unit_in_name
from estimator.records.units import REQUIRED, TIME, TRUTH, UNITS, VELOCITY_TIME

_AXES = {"x": ("x", "0"), "y": ("y", "1"), "z": ("z", "2")}
_WORDS = {
    "f": "f|force|ft|forces|load",
    "m": "m|t|torque|tau|moment|torques",
    "v": "v|vel|velocity|slip|linear|slip_velocity|slip_vel|twist",
    "w": "w|omega|angular|rate|slip_rate|rot|rotation",
}
_WHOLE = {
    TIME: r"((ft|f|force|wrench|header)_)?(t|time|stamp|time_?stamp|secs?|seconds|ms|elapsed|t_s|t_ms)",
    VELOCITY_TIME: r"velocity_t|(slip|vel|velocity|twist|v)_?(t|time|stamp)",
    "f_n": r"f_?n|normal(_force)?|pressure_force|grip(_force)?",
    "tau": r"tau(_?[nz])?|mz|tz|torsion|ft\[5\]",
    "omega": r"omega(_?[nz])?|wz|yaw_?rate|slip_?rate|slip_omega|slip\[2\]",
    "cop_x": r"cop_?x|cop\[0\]",
    "cop_y": r"cop_?y|cop\[1\]",
    "true_mu_s": "true_mu_s|mu_s",
    "true_mu_c": "true_mu_c|mu_c|mu_k",
    "true_r": "true_r",
}
_COMPONENT = {
    "f_x": "fx", "f_y": "fy", "f_n": "fz", "tau_x": "mx", "tau_y": "my", "tau": "mz",
    "v_x": "vx", "v_y": "vy", "omega": "wz",
}  # fmt: skip
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
    unit: str
    sign: int
    why: str
    """Reason for unit and sign."""
    values: Array
    """In SI units with the sign, NaN where a cell is empty."""


def propose(path: Path) -> tuple[list[Proposal], list[str]]:
    """Proposes what the columns of a file are.

    Args:
        path: A file that `load` reads, or the folder of a ROS 2 bag.

    Returns:
        The proposals, in the order of `UNITS`; the columns that nothing was found for.

    Raises:
        FileNotFoundError, ValueError, ModuleNotFoundError: As `load`.
    """
    frame, numeric = read_columns(path), {}
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
    found: dict[str, Proposal] = {}
    for key in (key for key in UNITS if key in chosen):
        values, dated = numeric[chosen[key]]
        alike = [numeric[chosen[other]][0] for other in chosen if UNITS[other] is UNITS[key]]
        unit, sign, why = ("s", 1, "dates") if dated else _unit(key, chosen[key], values, alike, found)
        found[key] = Proposal(key, chosen[key], unit, sign, why, sign * UNITS[key][unit] * values)
    return list(found.values()), [name for name in frame if name not in chosen.values()]


def mapping_text(proposals: list[Proposal]) -> str:
    """The mapping as YAML, with the reason of each line as a comment."""
    lines = ["# Proposed by slipgym map: look at every line. docs/records.md lists keys, units and frames."]
    for each in proposals:
        column = each.column.replace("'", "''")
        sign = ", sign: -1" if each.sign < 0 else ""
        lines.append(f"{each.key}: {{column: '{column}', unit: '{each.unit}'{sign}}}  # {each.why}")
    given = {each.key for each in proposals}
    lines += [f"# {key}: ?  nothing looks like it" for key in REQUIRED if key not in given]
    return "\n".join(lines) + "\n"


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
    if (
        VELOCITY_TIME in chosen
        and chosen.get(TIME)
        and lengths[chosen[TIME]] == lengths[chosen[VELOCITY_TIME]]
    ):
        del chosen[VELOCITY_TIME]
    return {key: chosen[key] for key in UNITS if key in chosen}


def _score(key: str, name: str) -> int:
    """How well a name says that a column is what a key means: 4 its key, 3 whole, 2 its end, 1 an axis."""
    plain = _UNIT.sub("", name).strip().lower().replace(" ", "_").replace("-", "_")
    if plain == key:
        return 4
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
    return int(key == "tau" and last == "ft[3]")  # of four columns


def _unit(
    key: str, name: str, values: Array, alike: list[Array], found: Mapping[str, Proposal]
) -> tuple[str, int, str]:
    """Unit, sign and their reason; the largest of the columns of a kind decides the unit of all."""
    stated, units = unit_in_name(key, name), UNITS[key]
    x = values[np.isfinite(values)]
    if key in (TIME, VELOCITY_TIME):
        step = float(np.median(np.abs(np.diff(np.unique(x))))) if len(x) > 1 else 0.0
        rates = {unit: 1.0 / (step * factor) for unit, factor in units.items()} if step else {}
        likely = [unit for unit, rate in rates.items() if RATES[0] <= rate <= RATES[1]]
        unit = stated or (likely[0] if likely else "s")
        return unit, 1, f"{rates[unit]:.4g} Hz" if rates else "one time"
    size = max(float(np.nanpercentile(np.abs(each), 99)) for each in alike)
    most = LIKELY["omega"] if key == "omega" else LIKELY["v"] if key in ("v_x", "v_y") else np.inf
    if key.startswith("f_"):
        most = LIKELY["f"]
    elif key.startswith("tau") and "f_n" in found:
        most = LIKELY["arm"] * float(np.nanpercentile(np.abs(found["f_n"].values), 99))
    fits = [unit for unit, factor in units.items() if size * factor <= most]
    unit = stated or (fits[0] if fits else next(iter(units)))
    sign, why = 1, "unit in its name" if stated else f"up to {size * units[unit]:.3g} {next(iter(units))}"
    pressed = x[np.abs(x) > 0.5 * np.max(np.abs(x))]
    if key == "f_n" and len(pressed) and float(np.median(pressed)) < 0.0:
        sign, why = -1, f"{why}; negative in contact"
    return unit, sign, why


def plot(proposals: list[Proposal], path: Path) -> None:
    """Draws every proposed column over the time of its stream, as a png."""
    pyplot = extra("matplotlib.pyplot")
    shown = [each for each in proposals if each.key not in (TIME, VELOCITY_TIME)]
    clocks = {each.key: each.values for each in proposals if each.key in (TIME, VELOCITY_TIME)}
    figure, axes = pyplot.subplots(len(shown), 1, sharex=True, figsize=(9, 1.3 * len(shown)), squeeze=False)
    for ax, each in zip(axes[:, 0], shown, strict=True):
        t = next((t for t in clocks.values() if len(t) == len(each.values)), np.arange(len(each.values)))
        there = np.isfinite(each.values)
        ax.plot((t - np.nanmin(t))[there], each.values[there], linewidth=0.8)
        ax.set_title(f"{each.key} = {each.column}", loc="left", fontsize=9)
        ax.set_ylabel(f"[{next(iter(UNITS[each.key]))}]")
    axes[-1, 0].set_xlabel("time [s]")
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    pyplot.close(figure)


def columns_left(names: list[Any], most: int = 12) -> str:
    """Names of columns that have no place, shortened."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(str(name) for name in names[:most]) + more
