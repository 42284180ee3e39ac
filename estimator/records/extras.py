"""Imports packages that only records need, on first use."""

from __future__ import annotations

import importlib
from typing import Any

_OF_RECORDS = ("h5py", "mcap", "openpyxl", "pyarrow", "rosbags", "scipy")
"""What the extra `records` installs; all else comes with `cli`."""


def extra(module: str) -> Any:
    """The module of that full name, which an extra of slipgym installs.

    Raises:
        ModuleNotFoundError: It is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        name = "records" if module.partition(".")[0] in _OF_RECORDS else "cli"
        message = f"{error.name} is not installed: pip install 'slipgym[{name}]'"
        raise ModuleNotFoundError(message, name=error.name) from error
