"""Finds the columns of a stream in the tables of a file, and brings those of other tables to its times."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from estimator.records.alignment import GAP_PERIODS, newest, period
from estimator.records.columns import Columns, Wanted, is_wanted
from estimator.records.extras import extra
from estimator.records.table import Table, listed
from estimator.records.units import ROWS, TIME, UNITS
from estimator.suggestions import brief


def read_tables(name: str, columns: Columns, read: Callable[[Wanted], list[Table]]) -> list[Table]:
    """Reads what a mapping may mean: a table for each topic or length; one of csv and parquet.

    Args:
        name: Of the file.
        columns: The mapping.
        read: Reads the columns of the file that are asked for.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It cannot be read as what its name says, or has a column twice.
    """
    mapped = [column.column for key in UNITS if (column := columns[key])] + list(columns.rows)
    tables = []
    for table in read(dict.fromkeys(mapped)):
        frame, units = table.frame, dict(table.units)
        for short in mapped:
            places = [str(k) for k, each in enumerate(frame.columns, start=1) if each == short]
            if len(places) > 1:
                raise ValueError(
                    f"{name}: {brief(repr(short))} is the name of columns {' and '.join(places[:5])}; "
                    "rename or remove all but one"
                )
        for short in dict.fromkeys(mapped):
            full = [each for each in frame.columns if is_wanted(each, (short,))]
            if short not in frame.columns and len(full) == 1:
                frame = frame.assign(**{short: frame[full[0]]})
                units.setdefault(short, units.get(full[0], ""))
        frame.index = extra("pandas").RangeIndex(len(frame))
        tables.append(table._replace(frame=frame, units=units, name=name, columns=columns))
    return tables


def of_one_finger(tables: Sequence[Table], columns: Columns) -> list[Table]:
    """The rows that the mapping keeps, of each table that has its column.

    Raises:
        ValueError: No table has it, or no row has its value.
    """
    tables, number = list(tables), extra("pandas").to_numeric
    for name, value in columns.rows.items():
        having = [k for k, table in enumerate(tables) if name in table.frame.columns]
        if not having:
            there = listed(tables[0].names)
            raise ValueError(f"{tables[0].name}: {ROWS}: no column {brief(repr(name))}; it has: {there}")
        for k in having:
            text = tables[k].frame[name].astype(object).map(str).str.strip()
            same = number(text, errors="coerce") == number(str(value), errors="coerce")
            frame = tables[k].frame[np.asarray(same | (text == str(value).strip()), bool)]
            if frame.empty:
                found = f"no row has {brief(name)} = {brief(value)}; it has: {listed(text.unique())}"
                raise ValueError(f"{tables[k].name}: {found}")
            tables[k] = tables[k]._replace(frame=frame)
    return tables


def stream(tables: Sequence[Table], keys: Sequence[str], others: Sequence[str] = ()) -> tuple[int, Table]:
    """The table that has most of the columns of a stream, and its place among the tables.

    Args:
        tables: Of one file.
        keys: What the stream consists of, without its time.
        others: Keys whose columns may be in another table; its newest value at or before each time is taken;
            a row that lacks one of the stream, because the other table has none or an old one, is left out.

    Raises:
        ValueError: Two tables have the same number of them.
    """
    there = list(dict.fromkeys(name for table in tables for name in table.names))
    names = {key: column.column for key in keys if (column := tables[0].columns[key])}
    counts = [sum(name in table.frame.columns for name in names.values()) for table in tables]
    alike = [table for table, count in zip(tables, counts, strict=True) if count == max(counts)]
    if len(alike) > 1 and max(counts):
        key, short = next((k, n) for k, n in names.items() if n in alike[0].frame.columns)
        full = [next(each for each in t.names if is_wanted(each, (short,))) for t in alike]
        raise ValueError(
            f"{tables[0].name}: {key} may be {listed(full)}; the mapping says which, as `{key}: {full[0]}`; "
            f"it has: {listed(there)}"
        )
    place = counts.index(max(counts))
    table = tables[place]._replace(names=there)
    for key in others:
        column = table.columns[key]
        if column is not None and column.column not in table.frame.columns:
            having = [each for each in tables if column.column in each.frame.columns]
            if len(having) == 1:
                table = _brought(table, having[0], column.column, key in keys)
    return place, table


def _brought(table: Table, other: Table, name: str, needed: bool) -> Table:
    """A table with a column of another one."""
    for each in (table, other):
        each.require([TIME])
    (t, _), (its, _) = table.seconds(TIME), other.seconds(TIME)
    at = newest(its, t)
    there = (at >= 0) & (t - its[at] <= GAP_PERIODS * max(period(its), period(t)))
    frame = table.frame.assign(**{name: other.frame[name].to_numpy()[at]})
    frame = frame[there] if needed else frame.assign(**{name: frame[name].where(there)})
    return table._replace(frame=frame, units={**table.units, name: other.units.get(name, "")})
