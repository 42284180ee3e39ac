"""Imports packages that only records need, on first use."""

from __future__ import annotations

import importlib
from typing import Any


def extra(module: str, name: str = "cli") -> Any:
    """Imports a module that an extra of slipgym installs.

    Args:
        module: Its full name.
        name: The extra: "cli", or "records" for HDF5, MATLAB, Excel, parquet, MCAP and ROS bags.

    Raises:
        ModuleNotFoundError: It is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        message = f"records need {error.name}, which is not installed: pip install 'slipgym[{name}]'"
        raise ModuleNotFoundError(message, name=error.name) from error
