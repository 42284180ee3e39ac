"""Imports packages that only records need, on first use."""

from __future__ import annotations

import importlib
from typing import Any


def extra(module: str) -> Any:
    """Imports a module that the extra `slipgym[eval]` installs.

    Args:
        module: Its full name.

    Raises:
        ModuleNotFoundError: It is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        message = f"records need {error.name}, which is not installed: pip install 'slipgym[eval]'"
        raise ModuleNotFoundError(message, name=error.name) from error
