"""Imports packages that only records need, on first use."""

from __future__ import annotations

import importlib
from typing import Any

_EXTRAS = {"h5py": "hdf5", "scipy": "mat", "openpyxl": "excel", "mcap": "mcap", "rosbags": "rosbag"}
"""Library -> the extra that installs it; all others come with `records`."""


def extra(module: str) -> Any:
    """Imports a module that one of the extras for records installs.

    Args:
        module: Its full name.

    Raises:
        ModuleNotFoundError: It is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        name = _EXTRAS.get(module.partition(".")[0], "records")
        message = f"{error.name} is not installed: pip install 'slipgym[{name}]'"
        raise ModuleNotFoundError(message, name=error.name) from error
