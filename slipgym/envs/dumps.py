"""Writes the samples before a number that is not finite to a folder that keeps the newest files."""

from __future__ import annotations

import os
import uuid
from pathlib import Path

from estimator.own_folder import own_temporary_folder
from slipgym import atomic_io

VARIABLE = "SLIPGYM_DUMPS"
"""Environment variable with the folder; without it, a folder of the user among the temporary files."""
KEPT = 20
"""Files that the folder keeps."""


def write_dump(content: bytes) -> Path | None:
    """Write a file, and remove the oldest beyond `KEPT`; None if it cannot be written.

    Args:
        content: Its content.
    """
    chosen = os.environ.get(VARIABLE)
    folder = Path(chosen) if chosen else own_temporary_folder("slipgym_dumps")
    if folder is None:
        return None
    path = folder / f"not-finite-{uuid.uuid4().hex}.csv"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        atomic_io.write(path, content)
        files = sorted(folder.glob("not-finite-*.csv"), key=lambda each: each.stat().st_mtime_ns)
        for old in files[:-KEPT]:
            old.unlink(missing_ok=True)
    except OSError:
        return path if path.is_file() else None
    return path
