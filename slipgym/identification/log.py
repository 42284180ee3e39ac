"""Reads and checks the log of a session on the bench."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from estimator.records.alignment import held
from estimator.records.checks import (
    OPPOSITE,
    USUAL_FORCE,
    USUAL_LEVER,
    USUAL_SPEED,
    check_rate,
    check_time,
    check_torque,
    check_wrench,
    correlation,
)
from estimator.records.columns import Columns
from estimator.records.extras import extra
from estimator.records.record import seconds
from estimator.records.sources import read_sources
from estimator.records.streams import of_one_finger, read_tables, stream
from estimator.records.table import Table, listed
from estimator.records.units import TIME, UNITS, VELOCITY_TIME, likely_unit
from estimator.suggestions import brief
from slipgym.identification.rollout import CHANNELS

COMMAND = "force"
MOTION = ("motion_x", "motion_y", "motion_omega")
COLUMNS = (TIME, COMMAND, *MOTION, *CHANNELS)
"""Columns of a log: time [s], grip command [N], motion and readings in SI units."""
SLIP = CHANNELS[4:]
"""Readings of the slip sensor, which may have times of their own."""
LEAST_NOISE = np.array([1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-5, 1e-4])
"""Of each reading, in its SI unit: no sensor is more exact, whatever a log shows."""
SHORTEST = 5.0  # [s]
LARGEST = {"N": 1e4, "N m": 1e4, "m/s": 5.0, "rad/s": 200.0}
"""Largest number of each unit, beyond what a bench has."""
_USUAL = {"N": USUAL_FORCE, "N m": USUAL_LEVER * USUAL_FORCE, "m/s": USUAL_SPEED, "rad/s": 3.0}
_ALIKE = 5.0
"""Ratio of the sizes of a motion and of what follows it, at most; noise makes less, by `OPPOSITE`."""
RATES = (20.0, 2000.0)  # [Hz]
ROWS_MAX = 200_000
_AROUND = 5
"""Rows before a gap, and after it, whose times are compared."""
_INSIDE = 0.5
"""Share of the slip samples that must lie in the time of the forces."""


@dataclass(frozen=True)
class Log:
    """A log of one finger on one clock, n rows in equal steps of time.

    Raises:
        ValueError: A shape, the rate, the length or a number is out of range.
    """

    rate: float
    """Rows per second [Hz]."""
    command: np.ndarray
    """Grip force commanded, (n,) [N]."""
    motion: np.ndarray
    """Twist of the object against the gripper, (n, 3) [m/s, m/s, rad/s]."""
    readings: np.ndarray
    """Wrench at the pad's centre and slip twist, (n, 7), see `CHANNELS`; NaN: a row without a slip sample."""

    def __post_init__(self) -> None:
        n = len(self.command)
        shapes = (self.command.shape, self.motion.shape, self.readings.shape)
        if shapes != ((n,), (n, 3), (n, len(CHANNELS))):
            raise ValueError(
                f"command, motion and readings have shapes {shapes}; must be (n,), (n, 3), (n, 7)"
            )
        numbers = np.hstack([self.command[:, None], self.motion, self.readings])
        numbers[np.isnan(self.readings[:, 4:]).all(axis=1), -3:] = 0.0
        if not np.isfinite(numbers).all():
            raise ValueError(
                "command, motion and readings must be finite; all three slip readings of a row may be NaN"
            )
        if not RATES[0] <= self.rate <= RATES[1]:
            raise ValueError(f"{self.rate:g} rows per second; must be {RATES[0]:g} to {RATES[1]:g}")
        if n / self.rate < SHORTEST:
            raise ValueError(f"the log is {n / self.rate:.3g} s long; must be at least {SHORTEST:g} s")
        if (self.command < 0.0).any():
            raise ValueError(f"{COMMAND} must be >= 0 N")

    def noise(self) -> np.ndarray:
        """Standard deviation of each reading's white noise, whatever moves, (7,); NaN where it is absent.

        From the median of third differences, in which smooth motion vanishes, and the steps of the converter.
        """
        there = [each[np.isfinite(each)] for each in self.readings.T]
        differences = [np.abs(np.diff(each, 3)) if len(each) > 3 else np.array([np.nan]) for each in there]
        spread = 1.4826 * np.array([np.median(each) for each in differences]) / np.sqrt(20.0)
        steps = [np.diff(np.unique(each)).min(initial=np.inf) for each in there]
        rounding = np.where(np.isfinite(steps), steps, 0.0) / np.sqrt(12.0)
        return np.maximum(np.maximum(spread, rounding), LEAST_NOISE)


def read_log(path: str | os.PathLike[str], columns: Columns | None = None) -> Log:
    """Reads a file of any type that records have; the columns of the slip twist may be absent.

    Args:
        path: A file with the columns `COLUMNS`, all on one clock. Velocities may be in other rows than
            forces, in another table, or have the time `velocity_t`.
        columns: The mapping of other names, units and signs; None: none.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A column is absent, not finite, or of another unit or sign than a gripper's or the
            motion's, or the time does not go on in equal steps; the message names file, column, row, value
            and range.
        ModuleNotFoundError: An extra is not installed.
    """
    path, columns = Path(path), columns or Columns()
    if columns.fingers:
        raise ValueError(
            f"{path.name}: the mapping is of the fingers {', '.join(columns.fingers)}; a log is of one"
        )
    tables = of_one_finger(read_tables(path.name, columns, partial(read_sources, path)), columns)
    place, table = stream(tables, CHANNELS[:4], (COMMAND, *MOTION))
    slow = stream(tables, SLIP)[1]
    there = [
        name
        for name in COLUMNS
        if (of := columns[name]) and of.column in (slow if name in SLIP else table).frame.columns
    ]
    slip = set(there) & set(SLIP)
    needed = COLUMNS if slip else COLUMNS[: -len(SLIP)]
    for name in needed:
        column = columns[name]
        if column is None or column.position:
            raise ValueError(f"{path.name}: {name} must be a column of the log, of its own unit")
        if name not in there:
            found = listed(list(dict.fromkeys(each for one in tables for each in one.names)))
            raise ValueError(
                f"{path.name}: column {column.column} is missing; a log has {', '.join(needed)}; a mapping "
                f"(--columns) gives them other names, units and signs; it has: {found}"
            )
    table = _filled(table, CHANNELS[:4])
    own = tables[place].frame.columns
    if brought := [name for name in (COMMAND, *MOTION) if table.column(name).column not in own]:
        table = _together(table, brought)
    t = table.seconds(TIME)[0]
    if (bad := ~np.isfinite(t)).any():
        raise ValueError(f"{table.name}: row {table.rows(np.flatnonzero(bad))[0]}: t must be a finite number")
    rate = _rate(table, t)
    values = np.stack([_numbers(table, name) for name in COLUMNS[1 : -len(SLIP)]], axis=1)
    readings = np.full((len(t), len(CHANNELS)), np.nan)
    readings[:, :4] = values[:, 4:]
    if slip:
        readings[:, 4:] = _slip(slow, t, rate)
    check_wrench(table.name, readings[:, :4], table.rows(np.arange(len(t))))
    check_torque(table.name, readings[:, :4])
    _check_signs(path.name, values[:, 1:4], readings)
    _check_sizes(path.name, values[:, :4], readings)
    if (negative := values[:, 0] < 0.0).any():
        raise ValueError(
            f"{path.name}: row {table.rows(np.flatnonzero(negative))[0]}: {COMMAND} must be >= 0 N"
        )
    try:
        return Log(rate, values[:, 0], values[:, 1:4], readings)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None


def _filled(table: Table, keys: Sequence[str]) -> Table:
    """The rows of a table that have a cell of a stream; all, if none has."""
    at = table.filled(keys)
    return table._replace(frame=table.frame.iloc[at]) if len(at) else table


def _together(table: Table, names: Sequence[str]) -> Table:
    """The rows from the first to the last one that has a value of each of these columns of another table."""
    cells = table.frame[[table.column(name).column for name in names]]
    there = np.flatnonzero(cells.notna().all(axis=1))
    if not len(there):
        raise ValueError(f"{table.name}: {', '.join(names)} have no time in common with the forces")
    return table._replace(frame=table.frame.iloc[there[0] : there[-1] + 1])


def _slip(table: Table, t: np.ndarray, rate: float) -> np.ndarray:
    """The slip twist at the time of each row that has a sample within half a row, (n, 3); NaN elsewhere."""
    table, own = _filled(table, SLIP), table.columns[VELOCITY_TIME]
    apart = own is not None and own.column in table.frame.columns
    time = VELOCITY_TIME if apart or VELOCITY_TIME in table.columns.given else TIME
    if time == TIME and table.column(TIME).column not in table.frame.columns:
        raise ValueError(
            f"{table.name}: the velocities are not as many as the forces and have no time; "
            f"`{VELOCITY_TIME}: NAME` in the mapping names its column"
        )
    table.require([time])
    (its, column), twist = table.seconds(time), np.stack([_numbers(table, name) for name in SLIP], axis=1)
    check_time(table.name, its, table.rows(np.arange(len(its))), "velocity")
    check_rate(table.name, its, "velocity", time, column)
    if (kept := held(its, twist)) is not None:
        its, twist = its[kept[0]], twist[kept[0]]
    rows = np.rint((its - t[0]) * rate)
    inside = (rows >= 0) & (rows < len(t))
    if inside.mean() < _INSIDE:
        raise ValueError(
            f"{table.name}: the velocities are of {its[0]:g} to {its[-1]:g} s, "
            f"the forces of {t[0]:g} to {t[-1]:g} s; on one clock?"
        )
    rows, slip = np.unique(rows[inside].astype(int)), np.full((len(t), len(SLIP)), np.nan)
    slip[rows] = np.stack([np.interp(t[rows], its, each) for each in twist.T], axis=1)
    return slip


def _numbers(table: Table, name: str) -> np.ndarray:
    try:
        numbers = table.numbers([name])[:, 0]
    except ValueError as error:  # of a cell that is text: the message below has the range
        cells = extra("pandas").to_numeric(table.frame[table.column(name).column], errors="coerce")
        if np.isfinite(numbers := cells.to_numpy(float)).all():
            raise ValueError(str(error)) from None
    unit = next(iter(UNITS[name]))
    k = int(np.argmax(np.abs(numbers))) if len(numbers) else 0  # the first that is no number, if one is none
    if len(numbers) and not abs(numbers[k]) <= LARGEST[unit]:
        found, ask = f"{numbers[k]:.4g} {unit}", ""
        if np.isfinite(numbers[k]):
            meant = likely_unit(name, abs(numbers[k]), _USUAL[unit])
            ask = f"; in {meant}? `{name}: {{unit: {meant}}}` in the mapping says so"
        else:
            found = brief(table.frame[table.column(name).column].iloc[k])
        raise ValueError(
            f"{table.name}: row {table.rows(np.array([k]))[0]}: {name} must be a finite number of at most "
            f"{LARGEST[unit]:g} {unit} in each row, is {found}{ask}"
        )
    return numbers


def _check_signs(file: str, motion: np.ndarray, readings: np.ndarray) -> None:
    """Refuses a motion that goes against the slip, or against the load of its friction on the finger."""
    of_each = zip(MOTION, motion.T, (0, 1, 3), (4, 5, 6), strict=True)
    for name, moves, load, slip in of_each:
        for k in (slip, load):
            if (along := correlation(moves, readings[:, k])) < -OPPOSITE:
                raise ValueError(
                    f"{file}: {name} goes against {CHANNELS[k]} (correlation {along:.2f}): it is the motion "
                    f"of the object against the gripper, minus the gripper's own; `{name}: {{sign: -1}}` in "
                    f"the mapping, or the sign of {CHANNELS[k]} if that is wrong"
                )


def _check_sizes(file: str, moves: np.ndarray, readings: np.ndarray) -> None:
    """Refuses a command (n,) or motion (n, 3), side by side, of another size than what follows it."""
    for name, given, k in zip((COMMAND, *MOTION), moves.T, (2, 4, 5, 6), strict=True):
        both = np.isfinite(readings[:, k])
        if correlation(given, readings[:, k]) < OPPOSITE:
            continue
        sizes = {name: float(given[both].std()), CHANNELS[k]: float(readings[both, k].std())}
        small, large = sorted(sizes, key=sizes.__getitem__)
        if sizes[large] > _ALIKE * sizes[small]:
            unit, meant = next(iter(UNITS[large])), likely_unit(large, sizes[large], sizes[small])
            ask = f"convert {large} to {unit}, or correct its column"
            if 1.0 <= _ALIKE * sizes[large] * UNITS[large][meant] / sizes[small] <= _ALIKE**2:
                ask = f"{large} in {meant}? `{large}: {{unit: {meant}}}` in the mapping says so"
            raise ValueError(
                f"{file}: {name} goes along with {CHANNELS[k]}, but changes by {sizes[name]:.3g} where that "
                f"changes by {sizes[CHANNELS[k]]:.3g} {unit} (standard deviations, at most {_ALIKE:g} times "
                f"the other); {ask}"
            )


def _rate(table: Table, t: np.ndarray) -> float:
    if not 2 <= len(t) <= ROWS_MAX:
        raise ValueError(f"{table.name}: has {len(t)} rows; a log has 2 to {ROWS_MAX}")
    step = (t[-1] - t[0]) / (len(t) - 1)
    off = t - t[0] - step * np.arange(len(t))
    if not step > 0.0 or (np.abs(off) > 0.5 * step).any() or (_shifts(off) > 0.5 * step).any():
        steps = np.diff(t)
        usual = np.median(steps)
        k = int(np.argmax(np.abs(steps - usual)))
        raise ValueError(
            f"{table.name}: row {table.rows(np.array([k + 1]))[0]}: t = {seconds(t[k + 1])} s is "
            f"{1e3 * steps[k]:.4g} ms after the row before, others {1e3 * usual:.4g} ms; "
            "t must rise in equal steps; resample onto one clock first"
        )
    return float(1.0 / step)


def _shifts(off: np.ndarray) -> np.ndarray:
    """How far times are shifted from one row to the next, by medians that leave jitter out [s]."""
    if len(off) < 2 * _AROUND:
        return np.zeros(1)
    level = np.median(np.lib.stride_tricks.sliding_window_view(off, _AROUND), axis=1)
    return np.abs(level[_AROUND:] - level[:-_AROUND])
