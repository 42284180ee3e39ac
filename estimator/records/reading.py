"""Reads and checks a record."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records import arrays, checks
from estimator.records.columns import Columns
from estimator.records.extras import extra
from estimator.records.holding import held
from estimator.records.record import Array, Record, Rows, cop_of_tilt, wrench_at
from estimator.records.table import Table, named_columns, of_one_finger, read_table, table_of
from estimator.records.units import COP, REQUIRED, TILT, TIME, TRUTH, VELOCITY_TIME
from estimator.suggestions import brief

CONTACT = 0.2
"""Normal force below which the centre of pressure is not defined [N]."""


def load(
    log: str | os.PathLike[str],
    columns: Columns | None = None,
    velocity: str | os.PathLike[str] | None = None,
) -> Record:
    """Reads and checks the record of one finger.

    In one file a cell is empty where its stream has no sample: force cells, velocity cells, or neither are
    empty in a row. In two files no cell is.

    Args:
        log: csv, csv.gz, parquet, xlsx, npz, HDF5, mat, mcap, bag or the folder of a ROS 2 bag, with forces
            and, unless `velocity` is given, velocities. A file of arrays may have velocities of another
            length, if the mapping names their time `velocity_t`.
        columns: The mapping; None for the default.
        velocity: A file of its own for the velocities, on the same clock.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The record cannot be what it should be; the message says where and what would do.
        ModuleNotFoundError: The extra that reads it is not installed.
    """
    columns = columns or Columns()
    if velocity is None and columns.given.get(VELOCITY_TIME) and Path(log).suffix.lower() in arrays.TYPES:
        velocity = log
    time = VELOCITY_TIME if columns.given.get(VELOCITY_TIME) else TIME
    forces = read_table(Path(log), columns)
    return _record(forces, None if velocity is None else read_table(Path(velocity), columns, time), columns)


def from_arrays(
    forces: Mapping[str, Any] | Any,
    velocities: Mapping[str, Any] | Any | None = None,
    columns: Columns | None = None,
    name: str = "arrays",
) -> Record:
    """The record of one finger from arrays or DataFrames, with the checks that a file gets.

    Args:
        forces: Name -> array (n,), or a pandas.DataFrame, with time and forces and, unless `velocities` is
            given, velocities. Names, units and signs are as in a file: `t` [s], `f_x`, ... [N].
        velocities: The same for velocities at times of their own, (m,).
        columns: The mapping; None for the default.
        name: What messages and reports call it.

    Raises:
        ValueError: As `load`; or arrays of one stream have different lengths.
        ModuleNotFoundError: pandas is not installed.
    """
    columns = columns or Columns()
    tables = [
        None if given is None else table_of(name, _frame_of(given, name), columns)
        for given in (forces, velocities)
    ]
    assert tables[0] is not None
    return _record(tables[0], tables[1], columns)


def _frame_of(given: Mapping[str, Any] | Any, name: str) -> Any:
    pandas = extra("pandas")
    if isinstance(given, pandas.DataFrame):
        return named_columns(given)
    if not isinstance(given, Mapping):
        raise ValueError(
            f"{name}: must be a mapping of names to arrays or a DataFrame, got {brief(type(given))}"
        )
    shapes = {str(key): np.shape(values) for key, values in given.items()}
    if len(set(shapes.values())) > 1 or any(len(shape) != 1 for shape in shapes.values()):
        listed = ", ".join(f"{brief(key)} {shape}" for key, shape in shapes.items())
        raise ValueError(f"{name}: arrays must be of one shape (n,), got {listed}")
    return named_columns(pandas.DataFrame({key: np.asarray(values) for key, values in given.items()}))


def _record(forces: Table, velocities: Table | None, columns: Columns) -> Record:
    together = velocities is None
    if velocities is None:
        forces.require(REQUIRED)
        if columns.given.get(VELOCITY_TIME):
            raise ValueError(f"{forces.name}: {VELOCITY_TIME} is for a file of velocities; give --velocity")
        (forces,) = of_one_finger([forces], columns)
        velocities, time = forces, TIME
    else:
        forces.require((TIME, *WRENCH))
        forces, velocities = of_one_finger([forces, velocities], columns)
        time = VELOCITY_TIME if columns.given.get(VELOCITY_TIME) else TIME
        velocities.require((time, *TWIST))
    extra_keys = _cop_keys(forces)
    force_t, wrench, at = _stream(forces, TIME, WRENCH, sparse=together, what="force")
    twist_t, twist, twist_at = _stream(velocities, time, TWIST, sparse=together, what="velocity")
    checks.check_wrench(forces.name, wrench, forces.rows(at))
    checks.check_twist(velocities.name, twist, velocities.rows(twist_at))
    cop = _cop(forces, extra_keys, wrench, at)
    if cop is not None:
        checks.check_cop(forces.name, cop)
        wrench = wrench_at(wrench, cop)
    checks.check_torque(forces.name, wrench)
    truth, hold = _truth(forces, at), None
    if (once := held(twist_t, twist)) is not None:
        delivered, hold = once
        twist_t, twist = twist_t[delivered], twist[delivered]
    return Record(forces.name, force_t, wrench, cop, twist_t, twist, truth, hold)


def _stream(
    table: Table, time: str, keys: tuple[str, ...], sparse: bool, what: str
) -> tuple[Array, Array, Rows]:
    """Time (n,), values (n, len(keys)) and places in the table (n,) of one stream."""
    (t, column), values = table.seconds(time), table.numbers(keys)
    empty = np.isnan(values)
    at: Any = np.flatnonzero(~empty.all(axis=1)) if sparse else np.arange(len(t))
    for k in at[empty[at].any(axis=1)][:1]:
        lacking = table.columns[keys[int(np.argmax(empty[k]))]]
        assert lacking is not None
        rest = "; a row holds all of a stream or none" if sparse else ""
        raise ValueError(f"{table.name}: row {table.rows(k)}: {brief(lacking.column)} is empty or NaN{rest}")
    checks.check_time(table.name, t[at], table.rows(at), what)
    checks.check_rate(table.name, t[at], what, time, column)
    return t[at], values[at], at


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
    values, f_n = table.numbers(keys)[at], wrench[:, 2]
    missing: Any = np.isnan(values).any(axis=1)
    lost = missing & (f_n >= CONTACT)
    if lost.any():
        row = table.rows(at)[np.argmax(lost)]
        raise ValueError(f"{table.name}: row {row}: {' or '.join(keys)} is empty or NaN")
    values = np.where(missing[:, None], 0.0, values)
    if keys == TILT:
        return cop_of_tilt(values, f_n, CONTACT)
    return values * (f_n >= CONTACT)[:, None]


def _truth(table: Table, at: Rows) -> Array | None:
    """True mu_s, mu_c, r by force sample (n, 3), NaN where unknown."""
    keys = [key for key in TRUTH if table.has(key)]
    if not keys:
        return None
    truth = np.full((len(at), len(TRUTH)), np.nan)
    truth[:, [TRUTH.index(key) for key in keys]] = table.numbers(keys)[at]
    return truth
