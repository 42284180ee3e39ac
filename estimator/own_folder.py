"""A folder among the temporary files that belongs to the user alone."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def own_temporary_folder(name: str) -> Path | None:
    """Make a folder that nobody but the user can write to; None if there can be none.

    Args:
        name: Its name, to which the number of the user is added.
    """
    try:
        temporary = Path(tempfile.gettempdir())
    except FileNotFoundError:  # none can be written
        return None
    if not hasattr(os, "getuid"):
        return temporary / name  # Windows: a folder of the user already
    user = os.getuid()
    folder = temporary / f"{name}_{user}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        state = folder.lstat()
    except OSError:
        return None
    return folder if folder.is_dir() and state.st_uid == user and not state.st_mode & 0o077 else None
