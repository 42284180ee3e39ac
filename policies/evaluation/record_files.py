"""Writes records of sensors as files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd

from estimator.records.extras import extra
from estimator.records.units import UNITS
from policies.evaluation.sensor_record import TWIST
from slipgym.atomic_io import check_file, new_file

WRITTEN = (".csv", ".csv.gz", ".parquet", ".h5", ".hdf5", ".mcap")
"""Types of files that can be written; `estimator.records.load` reads them all, and more."""
_BOTH = {".h5": "h5py", ".hdf5": "h5py", ".mcap": "mcap.writer"}
"""Types that hold both streams as tables of their own -> what writes them."""


def save_record(frame: pd.DataFrame, path: Path, velocity: Path | None = None) -> None:
    """Writes a record; a csv keeps seven digits, finer than any of the sensors; other types keep all.

    Args:
        frame: From `record_sensors`.
        path: Its type is in its name: one of `WRITTEN`.
        velocity: A file of its own for the velocities; None keeps all in one.

    Raises:
        ValueError: The type is unknown.
        OSError: A file cannot be written.
    """
    check_targets(path, velocity)
    forces = frame.drop(columns=list(TWIST)).loc[frame["f_n"].notna()]
    twists = frame.loc[frame["omega"].notna(), ["t", *TWIST]]
    if velocity is not None:
        _write(forces, path)
        _write(twists, velocity)
    elif path.suffix in _BOTH:
        with new_file(path) as partial:
            (_write_mcap if path.suffix == ".mcap" else _write_hdf5)(
                {"wrench": forces, "slip": twists}, partial
            )
    else:
        _write(frame, path)


def check_targets(path: Path, velocity: Path | None = None) -> None:
    """Finds out before an episode is played whether `save_record` can write these files.

    Raises:
        ValueError: The type of one is unknown, or a file of its own for the velocities makes no sense.
        ModuleNotFoundError: The library of a type is not installed.
        OSError: One cannot be written.
    """
    for target in (path, *([] if velocity is None else [velocity])):
        if not target.name.endswith(WRITTEN):
            raise ValueError(f"{target.name}: unknown file type; records are {', '.join(WRITTEN)}")
        if target.suffix in _BOTH:
            if velocity is not None:
                raise ValueError(f"{target.name}: holds both streams already; leave --velocity out")
            extra(_BOTH[target.suffix])
        check_file(target)


def _write(frame: pd.DataFrame, path: Path) -> None:
    with new_file(path) as partial:
        if path.suffix == ".parquet":
            frame.to_parquet(partial, index=False)
        else:
            packing: Any = {"method": "gzip", "mtime": 0} if path.suffix == ".gz" else None
            frame.to_csv(partial, index=False, float_format="%.7g", compression=packing)


def _write_hdf5(streams: dict[str, pd.DataFrame], path: Path) -> None:
    """A group for each stream, with a dataset for each column, and its unit."""
    with extra("h5py").File(path, "w") as file:
        for name, frame in streams.items():
            for column in frame:
                data = file.create_dataset(f"{name}/{column}", data=frame[column].to_numpy())
                data.attrs["unit"] = next(iter(UNITS[column]))


def _write_mcap(streams: dict[str, pd.DataFrame], path: Path) -> None:
    """A topic for each stream, with a message of JSON for each row; the time is that of the message."""
    with path.open("wb") as file:
        out = extra("mcap.writer").Writer(file)
        out.start(profile="", library="slipgym")
        for name, frame in streams.items():
            columns = [column for column in frame if column != "t"]
            fields = {
                column: {"type": "number", "description": next(iter(UNITS[column]))} for column in columns
            }
            schema = json.dumps({"type": "object", "properties": fields}).encode()
            number = out.register_schema(f"slipgym.{name}", "jsonschema", schema)
            channel = out.register_channel(f"/finger/{name}", "json", number)
            for t, *row in zip(frame["t"], *(frame[column] for column in columns), strict=True):
                told = {column: value for column, value in zip(columns, row, strict=True) if value == value}
                out.add_message(channel, round(t * 1e9), json.dumps(told).encode(), round(t * 1e9))
        out.finish()
