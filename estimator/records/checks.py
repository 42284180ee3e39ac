"""Checks of a record: each raises ValueError, whose message says what to do.

The bounds are an order of magnitude beyond the finger of a gripper, so every plausible record passes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records.columns import Column
from estimator.records.record import Array, Rows, seconds
from estimator.records.units import ROWS, TIME, UNITS, likely_unit

_FORCE_MAX = 500.0  # median force [N]
_FORCE_PEAK = 2e4  # [N]
_SPEED_MAX = 5.0  # [m/s]
_SPIN_MAX = 200.0  # [rad/s]
_COP_MAX = 0.5  # median distance of the centre of pressure from the origin [m]
_LEVER_MAX = 0.1  # torque at the centre of pressure over normal force [m]
USUAL_FORCE, USUAL_SPEED, _USUAL_SPIN, USUAL_LEVER = 10.0, 0.05, 3.0, 0.004
"""Peaks that a grip has [N, m/s, rad/s], and torque over normal force [m], by which a unit is guessed."""
_RISES = 0.3  # correlation of friction with f_n that shows its sign
OPPOSITE = 0.3
"""Least correlation that shows that a sign is wrong [-]."""
_PERIODS = (1e-5, 1.0)  # [s]
_USUAL_PERIODS = (4e-5, 0.105)
"""Sample periods, 10 Hz to 25 kHz, for which seconds need not be stated [s]."""
_SPANS = 0.1, 3600.0
"""Shortest and longest likely record [s]: too short for a slip, and an hour."""
_SINCE_1970 = 1.2e9, 2.2e9
"""Seconds of a clock that counts from 1970, in 2008 to 2039."""

_REPEATED = (
    f"if its rows are of two fingers, `{ROWS}: {{finger: 1}}` in the mapping keeps those with 1 in a column "
    "finger, and without such a column each finger needs a file; if the time has too few digits, write "
    "more; else drop repetitions"
)


def check_time(source: str, t: Array, rows: Rows, what: str) -> None:
    """Refuses times of a stream, (n,) [s], that are missing or do not increase, by their rows in the file."""
    if len(t) < 2:
        raise ValueError(f"{source}: {len(t)} {what} samples; at least 2 are needed")
    if np.isnan(t).any():
        raise ValueError(f"{source}: row {rows[np.argmax(np.isnan(t))]}: the time is missing")
    step = np.diff(t)
    if (step <= 0.0).any():
        k = int(np.argmax(step <= 0.0))
        how, advice = "goes back from", "sort the record"
        if step[k] == 0.0:
            how, advice = "repeats", _REPEATED
        elif (step <= 0.0).all():
            advice = (
                "the time runs backwards throughout: sort the record by it, or, if its clock counts down, "
                "state `sign: -1` of its column in the mapping"
            )
        elif t[k + 1] <= t[0]:
            advice = "where a counter wraps or a second record begins, make two files"
        raise ValueError(
            f"{source}: row {rows[k + 1]}: the time {seconds(t[k + 1])} s {how} the {seconds(t[k])} s "
            f"of row {rows[k]}; {advice}"
        )


def check_rate(source: str, t: Array, what: str, key: str, column: Column | None) -> list[str]:
    """Refuses sample rates that no sensor of slip has, and unusual ones if the unit is not stated.

    Returns:
        The units in which the rate is usual, if neither unit nor scale is stated; else none.

    Args:
        source: Name of the file.
        t: Increasing, (n,) [s].
        what: "force" or "velocity".
        key: Key of the time.
        column: Its column; None if it is of dates or durations, which have a unit of their own.
    """
    period = float(np.median(np.diff(t)))
    least, most = _USUAL_PERIODS if column is not None and column.assumed else _PERIODS
    if least <= period <= most:
        unstated = column is not None and column.assumed and abs(column.factor) == 1.0
        return _usual(period, UNITS[key]) if unstated else []
    message = f"{source}: {what} samples are {period:.4g} s apart"
    if column is None:
        raise ValueError(f"{message}; is that the time at which they were taken?")
    counts, units = period / abs(column.factor), UNITS[key]
    meant = _usual(counts, units)
    says = f"`{key}: {{unit: {(meant or ['…'])[0]}}}` in the mapping says so"
    ask = f"is the time in {meant[0]}? {says}" if meant else f"convert it to {', '.join(units)}; {says}"
    right = f"; if it is in {column.unit}, `{key}: {{unit: {column.unit}}}`"
    raise ValueError(f"{message}; {ask}{right if _PERIODS[0] <= period <= _PERIODS[1] else ''}")


def _usual(period: float, units: Mapping[str, float]) -> list[str]:
    """The units in which a period is that of a usual sample rate."""
    return [unit for unit in units if _USUAL_PERIODS[0] <= period * units[unit] <= _USUAL_PERIODS[1]]


def likely_time(t: Array, units: Mapping[str, float]) -> list[str]:
    """The units in which increasing times (n,) have a usual rate and length, or are those of a clock."""
    usual, span = _usual(float(np.median(np.diff(t))), units), t[-1] - t[0]
    dated = [unit for unit in usual if _SINCE_1970[0] <= t[0] * units[unit] <= _SINCE_1970[1]]
    return dated or [unit for unit in usual if _SPANS[0] <= span * units[unit] <= _SPANS[1]]


def check_time_unit(source: str, t: Array, usual: Sequence[str]) -> str:
    """Refuses a time without a unit that is far more likely in another one than seconds.

    Args:
        source: Name of the file.
        t: Of the forces, (n,) [s], if the time is in seconds.
        usual: Units in which the rates of all streams on this clock are usual.

    Returns:
        A warning, if seconds and another unit are both likely; else an empty text.
    """
    likely = likely_time(t, {unit: UNITS[TIME][unit] for unit in usual})
    if len(usual) < 2 or likely in ([], usual[:1]):
        return ""
    step, span = float(np.median(np.diff(t))), t[-1] - t[0]
    each = (
        f"in {unit} the forces have {1.0 / (step * factor):.5g} Hz for {span * factor:.3g} s"
        for unit, factor in UNITS[TIME].items()
        if unit in usual
    )
    says = " or ".join(f"`{TIME}: {{unit: {unit}}}`" for unit in usual)
    message = f"the unit of {TIME} is not stated: {', '.join(each)}; {says} in the mapping says which"
    if usual[0] not in likely:
        raise ValueError(f"{source}: {message}")
    return f"{message}; it is read in {usual[0]}."


def check_wrench(source: str, wrench: Array, rows: Rows) -> None:
    """Refuses normal forces of the wrong sign, and forces of the wrong unit, in wrenches (n, 4)."""
    f_n = wrench[:, WRENCH.index("f_n")]
    typical = np.median(f_n)
    if np.quantile(f_n, 0.99) < 0.0 or (typical < 0.0 and -f_n.min() > 10.0 * f_n.max()):
        turn = "`f_n: {sign: -1}` in the mapping turns it"
        f_t = np.hypot(wrench[:, 0], wrench[:, 1])
        varies = min(f_t.std(), f_n.std()) > 0.01 * abs(typical)
        if varies and np.corrcoef(f_t, f_n)[0, 1] > _RISES:  # friction rises with pressure, whatever its zero
            turn = (
                "friction rises with it, so that its sign is right and the sensor was zeroed in the grip: "
                "zero it with the open gripper, or add the force that it had then, at least "
                f"{-f_n.min():.3g} N, by `f_n: {{offset: {-f_n.min():.3g}}}`"
            )
        raise ValueError(
            f"{source}: f_n is negative throughout (median {typical:.4g} N), but pressure is positive; {turn}"
        )
    for k, name in enumerate(WRENCH[:3]):
        if (typical := np.median(np.abs(wrench[:, k]))) > _FORCE_MAX:
            raise ValueError(
                f"{source}: median of {name} is {typical:.4g} N; in mN? `{name}: {{unit: mN}}` says so"
            )
    _bounded(source, WRENCH[:3], wrench, rows, ((_FORCE_PEAK, USUAL_FORCE),) * 3)


def check_torque(source: str, wrench: Array) -> None:
    """Refuses torques at the centre of pressure, in wrenches (n, 4), that no friction of the forces makes."""
    force, torque = (np.quantile(np.abs(wrench[:, k]), 0.95) for k in (2, 3))
    if torque > _LEVER_MAX * max(force, 1.0):
        unit = likely_unit("tau", float(torque), USUAL_LEVER * max(force, 1.0))
        raise ValueError(
            f"{source}: tau reaches {torque:.4g} N m where f_n reaches {force:.4g} N, more than a finger pad "
            f"can hold; in {unit}? `tau: {{unit: {unit}}}` says so. Taken far from the pad? Then the record "
            "needs the CoP (cop_x, cop_y) or the tilting torques (tau_x, tau_y)"
        )


def check_twist(source: str, twist: Array, rows: Rows) -> None:
    """Refuses velocities (m, 3) [m/s, m/s, rad/s] that no slip in a grip has."""
    _bounded(source, TWIST, twist, rows, (*((_SPEED_MAX, USUAL_SPEED),) * 2, (_SPIN_MAX, _USUAL_SPIN)))


def _bounded(source: str, names: Sequence[str], values: Array, rows: Rows, bounds: Any) -> None:
    for k, (bound, usual) in enumerate(bounds):
        worst, unit = int(np.argmax(np.abs(values[:, k]))), next(iter(UNITS[names[k]]))
        if abs(values[worst, k]) > bound:
            meant = likely_unit(names[k], float(abs(values[worst, k])), usual)
            raise ValueError(
                f"{source}: row {rows[worst]}: {names[k]} = {values[worst, k]:.4g} {unit}, "
                f"above {bound:g}; in {meant}? `{names[k]}: {{unit: {meant}}}` says so"
            )


def check_cop(source: str, cop: Array) -> None:
    """Refuses a centre of pressure, (n, 2) [m], far from any pad."""
    distance = np.median(np.hypot(cop[:, 0], cop[:, 1]))
    if distance > _COP_MAX:
        raise ValueError(
            f"{source}: the CoP is {distance:.4g} m from the origin; "
            "cop_x and cop_y in mm, or tau_x and tau_y in N mm? `{unit: …}` in the mapping says so"
        )


def correlation(a: Array, b: Array) -> float:
    """Correlation of two columns (n,) where both have a number; 0 if one does not change."""
    if len(a) != len(b):
        return 0.0
    both = np.isfinite(a) & np.isfinite(b)
    if both.sum() < 3 or np.ptp(a[both]) == 0.0 or np.ptp(b[both]) == 0.0:
        return 0.0
    return float(np.corrcoef(a[both], b[both])[0, 1])
