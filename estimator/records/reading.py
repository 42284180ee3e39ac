"""Reads and checks a record."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records import checks
from estimator.records.columns import Columns
from estimator.records.holding import held
from estimator.records.record import Array, Record, Rows, cop_of_tilt, wrench_at
from estimator.records.table import Table, of_one_finger, read_table
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
        log: csv, csv.gz or parquet with forces and, unless `velocity` is given, velocities.
        columns: The mapping; None for the default.
        velocity: A file of its own for the velocities, on the same clock.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The record cannot be what it should be; the message says where and what would do.
        ModuleNotFoundError: The extra `slipgym[eval]` is not installed.
    """
    columns = columns or Columns()
    forces = read_table(Path(log), columns)
    if velocity is None:
        forces.require(REQUIRED)
        if columns.given.get(VELOCITY_TIME):
            raise ValueError(f"{forces.name}: {VELOCITY_TIME} is for a file of velocities; give --velocity")
        (forces,) = of_one_finger([forces], columns)
        velocities, time = forces, TIME
    else:
        forces.require((TIME, *WRENCH))
        forces, velocities = of_one_finger([forces, read_table(Path(velocity), columns)], columns)
        time = VELOCITY_TIME if columns.given.get(VELOCITY_TIME) else TIME
        velocities.require((time, *TWIST))
    extra_keys = _cop_keys(forces)
    force_t, wrench, at = _stream(forces, TIME, WRENCH, sparse=velocity is None, what="force")
    twist_t, twist, twist_at = _stream(velocities, time, TWIST, sparse=velocity is None, what="velocity")
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
