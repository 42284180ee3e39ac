"""Reads and writes the folder of a run: its configuration, curve and result; locks it."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from policies.training import checkpoints, seeds
from policies.training.config import Training
from policies.training.curve import Row
from policies.training.files import checked
from policies.versions import write_versions
from slipgym import atomic_io
from slipgym.config import files

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LOCK = ".lock"
"""Name of the file that is locked; it stays in the folder."""
SWEEP = "optuna.journal"
"""Name of the file that the folder of a sweep has."""
_ORDER, _RESULT, _CURVE = "run.yaml", "result.json", "curve.csv"
_NONE = f"{{}} holds no training run: there is no {_ORDER} in it"


def begin(folder: Path, config: Training, seed: int) -> None:
    """Makes the folder of a run that has not started yet.

    Raises:
        FileExistsError: There is one.
        ValueError: The seed is out of range.
    """
    seeds.training(seed)
    folder.mkdir(parents=True)
    checkpoints.folder(folder).mkdir()
    write_versions(folder)
    order = {"seed": seed, "training": config.model_dump(mode="json")}
    atomic_io.write(folder / _ORDER, yaml.safe_dump(order, sort_keys=False, allow_unicode=True).encode())


def order(folder: Path) -> tuple[Training, int]:
    """Configuration and seed of a run.

    Raises:
        FileNotFoundError: The folder holds no run.
        ValueError: What is asked for there is wrong.
    """
    path = folder / _ORDER
    if not path.is_file():
        raise FileNotFoundError(_NONE.format(folder))
    values = files.read(path)
    training, seed = values.get("training"), values.get("seed")
    if not isinstance(training, Mapping) or type(seed) is not int:
        raise ValueError(f"{path}: must hold a mapping 'training' and a whole number 'seed'")
    return checked(training, str(path)), seed


def runs(folder: Path) -> list[Path]:
    """The runs of a folder: itself, or those in it.

    Raises:
        FileNotFoundError: There are none.
    """
    if (folder / _ORDER).is_file():
        return [folder]
    found = sorted(path.parent for path in folder.glob(f"*/{_ORDER}"))
    if not found:
        raise FileNotFoundError(_NONE.format(folder))
    return found


def write_curve(folder: Path, curve: Sequence[Row]) -> None:
    """Writes curve.csv: a row for each evaluation."""
    table = pd.DataFrame(list(curve), columns=[field.name for field in fields(Row)])
    atomic_io.write(folder / _CURVE, table.to_csv(index=False, lineterminator="\n", na_rep="nan").encode())


def read_curve(folder: Path) -> list[Row]:
    """The evaluations of a run so far."""
    path = folder / _CURVE
    if not path.is_file():
        return []
    lines = path.read_text(encoding="utf-8").splitlines()[1:]
    return [Row(int(steps), *map(float, means)) for steps, *means in csv.reader(lines)]


def write_result(folder: Path, result: dict[str, Any]) -> None:
    """Writes result.json, which says that the run is over."""
    atomic_io.write(folder / _RESULT, (json.dumps(result, indent=2) + "\n").encode())


def result(folder: Path) -> dict[str, Any] | None:
    """Result of a run; None before its end."""
    path = folder / _RESULT
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


@contextmanager
def only_process(folder: Path) -> Iterator[None]:
    """Hold the folder of a run; a process that ends, however it does, gives it back.

    Where files cannot be locked (Windows, some network file systems) nothing is held.

    Raises:
        ValueError: Another process holds it.
        OSError: The folder cannot be written to.
    """
    handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        if fcntl is not None:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                said = f"{folder}: another process trains this run; wait for it, or end it"
                raise ValueError(said) from None
            except OSError:  # a file system without locks
                pass
        yield
    finally:
        os.close(handle)
