"""The checkpoints of a run: the last few and the best, each one whole file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from policies.training import checkpoint_io

_SUFFIX = ".checkpoint"


def folder(run: Path) -> Path:
    """Folder of the checkpoints of a run."""
    return run / "checkpoints"


def best(run: Path) -> Path:
    """The best one of a run, see `policies.training.curve.best`."""
    return folder(run) / f"best{_SUFFIX}"


def kept(run: Path) -> list[Path]:
    """The last ones of a run, oldest first."""
    return sorted(path for path in folder(run).glob(f"*{_SUFFIX}") if path.stem.isdigit())


def save(run: Path, steps: int, state: Any, keep: int) -> None:
    """Writes a checkpoint, then removes those before the last `keep`; OSError if it cannot be written."""
    checkpoint_io.write(folder(run) / f"{steps:012d}{_SUFFIX}", state)
    for path in kept(run)[:-keep]:
        path.unlink()


def last(run: Path) -> Any:
    """The newest readable checkpoint of a run; None if there is none yet.

    Raises:
        ValueError: There are checkpoints, and all are damaged.
    """
    found = kept(run)
    while found:
        try:
            return checkpoint_io.read(found.pop())
        except ValueError:
            if not found:
                raise
    return None
