"""Writes records of sensors as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from policies.evaluation.sensor_record import TWIST
from slipgym.atomic_io import check_file, new_file

TYPES = (".csv", ".csv.gz", ".parquet")


def save_record(frame: pd.DataFrame, path: Path, velocity: Path | None = None) -> None:
    """Writes a record; a csv keeps seven digits, which is finer than any of the sensors.

    Args:
        frame: From `record_sensors`.
        path: Its type is in its name: one of `TYPES`.
        velocity: A file of its own for the velocities; None keeps all in one.

    Raises:
        ValueError: The type is unknown.
        OSError: A file cannot be written.
    """
    check_targets(path, velocity)
    if velocity is None:
        _write(frame, path)
        return
    twists = ["t", *TWIST]
    forces = frame.drop(columns=list(TWIST))
    _write(forces.loc[forces["f_n"].notna()], path)
    _write(frame.loc[frame["omega"].notna(), twists], velocity)


def check_targets(path: Path, velocity: Path | None = None) -> None:
    """Finds out before an episode is played whether `save_record` can write these files.

    Raises:
        ValueError: The type of one is unknown.
        OSError: One cannot be written.
    """
    for target in (path, *([] if velocity is None else [velocity])):
        if not target.name.endswith(TYPES):
            raise ValueError(f"{target.name}: unknown file type; records are {', '.join(TYPES)}")
        check_file(target)


def _write(frame: pd.DataFrame, path: Path) -> None:
    with new_file(path) as partial:
        if path.suffix == ".parquet":
            frame.to_parquet(partial, index=False)
        else:
            packing: Any = {"method": "gzip", "mtime": 0} if path.suffix == ".gz" else None
            frame.to_csv(partial, index=False, float_format="%.7g", compression=packing)
