"""Reads and checks a record."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records import checks
from estimator.records.alignment import GAP_PERIODS, held
from estimator.records.columns import Columns, Wanted
from estimator.records.extras import extra
from estimator.records.record import Array, Record, Rows, cop_of_tilt, wrench_at
from estimator.records.sources import of_frame, read_sources
from estimator.records.streams import of_one_finger, read_tables, stream
from estimator.records.table import Table, listed
from estimator.records.units import COP, GRIP, REQUIRED, TILT, TIME, TRUTH, VELOCITY_TIME
from estimator.suggestions import brief

CONTACT = 0.2
"""Normal force below which the centre of pressure is not defined [N]."""


def load(
    log: str | os.PathLike[str],
    columns: Columns | None = None,
    velocity: str | os.PathLike[str] | None = None,
) -> Record:
    """Reads and checks the record of one finger.

    In one table a cell is empty where its stream has no sample: force cells, velocity cells, or neither are
    empty in a row. Where forces and velocities are in two files, topics or groups of arrays, no cell is.

    Args:
        log: A file of one of `TYPES`, with forces and, unless `velocity` is given, velocities.
        columns: The mapping; None for the default.
        velocity: A file of its own for the velocities, on the same clock.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The record cannot be what it should be; the message says where and what would do.
        ModuleNotFoundError: An extra is not installed.
    """
    columns = columns or Columns()
    files = [Path(each) for each in (log, velocity) if each is not None]
    found = [read_tables(path.name, columns, partial(read_sources, path)) for path in files]
    return _record(found, columns)


def from_arrays(
    forces: Mapping[str, Any] | Any,
    velocities: Mapping[str, Any] | Any | None = None,
    columns: Columns | None = None,
    name: str = "arrays",
) -> Record:
    """The record of one finger from arrays or DataFrames, with the checks that a file gets.

    Args:
        forces: Name -> array (n,), or a pandas.DataFrame, with time and forces and, unless `velocities` is
            given, velocities. Names, units and signs are as in a file: `t` [s], `f_x`, ... [N]. A masked
            cell is an empty one.
        velocities: The same for velocities at times of their own, (m,).
        columns: The mapping; None for the default.
        name: What messages and reports call it.

    Raises:
        ValueError: As `load`; or arrays of one stream have different lengths.
        ModuleNotFoundError: pandas is not installed.
    """
    columns = columns or Columns()
    given = [each for each in (forces, velocities) if each is not None]
    return _record([read_tables(name, columns, partial(_of_memory, each, name)) for each in given], columns)


def _of_memory(given: Mapping[str, Any] | Any, name: str, wanted: Wanted) -> list[Table]:
    """The columns of a DataFrame, or of a mapping of names to arrays (n,)."""
    pandas = extra("pandas")
    if isinstance(given, pandas.DataFrame):
        return [of_frame(given)]
    if not isinstance(given, Mapping):
        kind = brief(type(given).__name__)
        raise ValueError(f"{name}: must be a mapping of names to arrays or a DataFrame, got {kind}")
    try:
        arrays = {
            str(key): values if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
            for key, values in given.items()
        }
    except ValueError as error:
        raise ValueError(f"{name}: cannot be read: {brief(error, 300)}") from error
    shapes = {key: values.shape for key, values in arrays.items()}
    if len(set(shapes.values())) > 1 or any(len(shape) != 1 for shape in shapes.values()):
        listing = ", ".join(f"{brief(key)} {shape}" for key, shape in shapes.items())
        raise ValueError(f"{name}: arrays must be of one shape (n,), got {listing}")
    return [of_frame(pandas.DataFrame(arrays))]


def _record(files: list[list[Table]], columns: Columns) -> Record:
    """A record of the tables of one file, or of one for the forces and one for the velocities."""
    if columns.fingers:
        names = list(columns.fingers)
        raise ValueError(
            f"{files[0][0].name}: the mapping is of the fingers {', '.join(names)}; a record is of one; "
            f"its mapping is `columns.fingers[{names[0]!r}]`"
        )
    tables, count = of_one_finger([table for tables in files for table in tables], columns), len(files[0])
    others = [key for key in (*WRENCH, *COP, *TILT, GRIP, *TRUTH) if columns.given.get(key)]
    place, forces = stream(tables[:count], WRENCH, others)
    of_twists = (place, forces) if len(tables) == 1 else stream(tables[count:] or tables, TWIST)
    sparse, velocities = len(files) == 1 and of_twists[0] == place, of_twists[1]
    time = _time_of_velocities(velocities, TIME if sparse else None)
    if sparse:
        forces.require(tuple(dict.fromkeys((*REQUIRED, time))))
    forces.require((TIME, *WRENCH))
    velocities.require((time, *TWIST))
    extra_keys = _cop_keys(forces)
    force_t, wrench, at, usual = _stream(forces, TIME, WRENCH, sparse, what="force")
    twist_t, twist, twist_at, hold, its_usual = _velocities(velocities, time, sparse)
    usual = [unit for unit in usual if time != TIME or unit in its_usual]  # one clock has one unit
    doubt = checks.check_time_unit(forces.name, force_t, usual)
    checks.check_wrench(forces.name, wrench, forces.rows(at))
    checks.check_twist(velocities.name, twist, velocities.rows(twist_at))
    cop = _cop(forces, extra_keys, wrench, at)
    if cop is not None:
        checks.check_cop(forces.name, cop)
        wrench_at(wrench, cop)
    checks.check_torque(forces.name, wrench)
    own = columns.given.get(GRIP) and forces.has(GRIP)  # a column of that name may be anything
    grip = forces.numbers([GRIP], at)[:, 0] if own else None
    truth = _truth(forces, at)
    return Record(forces.name, force_t, wrench, cop, twist_t, twist, truth, hold, grip=grip, doubt=doubt)


def _time_of_velocities(table: Table, default: str | None) -> str:
    """The key of their time: their own if the mapping has it, or if the table has it and no other."""
    own, there = table.columns[VELOCITY_TIME], table.frame.columns
    if VELOCITY_TIME in table.columns.given and own is not None:
        if default and own.column not in there:
            raise ValueError(
                f"{table.name}: {VELOCITY_TIME}: no column {brief(repr(own.column))}; it has: "
                f"{listed(table.names)}; for a file of velocities, give --velocity"
            )
        return VELOCITY_TIME
    time = table.columns[TIME]
    other = default is None and own is not None and own.column in there
    return VELOCITY_TIME if other and (time is None or time.column not in there) else TIME


def _velocities(table: Table, time: str, sparse: bool) -> tuple[Array, Array, Rows, float | None, list[str]]:
    """Time (m,), velocities (m, 3), places in the table, for how long the file repeats each, usual units.

    A velocity of positions is their difference over the time between two samples, at the later one: without
    a sample before it, or after a gap, there is none.
    """
    t, twist, at, usual = _stream(table, time, TWIST, sparse, what="velocity")
    counted = [k for k, key in enumerate(TWIST) if (column := table.columns[key]) and column.position]
    for k in set(counted) & {TWIST.index("omega")}:
        twist[:, k] = np.unwrap(twist[:, k])
    hold = None
    if (once := held(t, twist)) is not None:
        delivered, hold = once
        t, twist, at = t[delivered], twist[delivered], at[delivered]
    if counted:
        step = np.diff(t)
        twist[1:, counted] = np.diff(twist[:, counted], axis=0) / step[:, None]
        local = np.flatnonzero(step <= GAP_PERIODS * np.median(step)) + 1
        t, twist, at = t[local], twist[local], at[local]
    return t, twist, at, hold, usual


def _stream(
    table: Table, time: str, keys: tuple[str, ...], sparse: bool, what: str
) -> tuple[Array, Array, Rows, list[str]]:
    """Time (n,), values (n, len(keys)) and places in the table (n,) of one stream; see `check_rate`."""
    at = table.filled(keys) if sparse else np.arange(len(table.frame))
    (t, column), values = table.seconds(time, at), table.numbers(keys, at)
    empty = np.isnan(values)
    if empty.any():
        k = int(np.argmax(empty.any(axis=1)))
        lacking = table.column(keys[int(np.argmax(empty[k]))]).column
        rest = "; a row holds all of a stream or none" if sparse else ""
        raise ValueError(f"{table.name}: row {table.rows(at)[k]}: {brief(lacking)} is empty or NaN{rest}")
    checks.check_time(table.name, t, table.rows(at), what)
    return t, values, at, checks.check_rate(table.name, t, what, time, column)


def _cop_keys(table: Table) -> tuple[str, ...]:
    """The keys that say where the centre of pressure is; empty if the record does not."""
    pairs = {pair: [key for key in pair if table.has(key)] for pair in (COP, TILT)}
    for pair, found in pairs.items():
        if len(found) == 1:
            (other,) = set(pair) - set(found)
            raise ValueError(
                f"{table.name}: {found[0]} without {other}; add it, or `{found[0]}: null` in the mapping"
            )
    if pairs[COP] and pairs[TILT]:
        raise ValueError(
            f"{table.name}: both {' and '.join(COP)} and {' and '.join(TILT)} tell the CoP; "
            f"leave two out with `{TILT[0]}: null` and `{TILT[1]}: null` in the mapping"
        )
    return tuple(pairs[COP] or pairs[TILT])


def _cop(table: Table, keys: tuple[str, ...], wrench: Array, at: Rows) -> Array | None:
    """Centre of pressure by force sample (n, 2) [m]; out of contact, the origin."""
    if not keys:
        return None
    values, f_n = table.numbers(keys, at), wrench[:, 2]
    missing: Any = np.isnan(values).any(axis=1)
    lost = missing & (f_n >= CONTACT)
    if lost.any():
        row = table.rows(at)[np.argmax(lost)]
        raise ValueError(f"{table.name}: row {row}: {' or '.join(keys)} is empty or NaN")
    values[missing] = 0.0
    if keys == TILT:
        return cop_of_tilt(values, f_n, CONTACT)
    return values * (f_n >= CONTACT)[:, None]


def _truth(table: Table, at: Rows) -> Array | None:
    """True mu_s, mu_c, r by force sample (n, 3), NaN where unknown."""
    keys = [key for key in TRUTH if table.has(key)]
    if not keys:
        return None
    truth = np.full((len(at), len(TRUTH)), np.nan)
    truth[:, [TRUTH.index(key) for key in keys]] = table.numbers(keys, at)
    return truth
