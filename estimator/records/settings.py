"""Parses settings of the command line, and names the folder of a run."""

from __future__ import annotations

import os
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from estimator.records.extras import extra


def parse_settings(settings: Sequence[str], flag: str = "--set") -> dict[str, Any]:
    """Reads `name=value` pairs; a value is what YAML takes it for, and 1e-3 is a number.

    Args:
        settings: Such as ["heuristic=false", "eps_v=1e-3"].
        flag: The option of the command line they were given by, for the message of an error.

    Raises:
        ValueError: One has no "=", or its value is no YAML.
    """
    values = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        if not equals or not name.strip():
            raise ValueError(f"{flag} {setting!r}: must be name=value")
        values[name.strip()] = _value(f"{flag} {setting!r}", text)
    return values


def _value(source: str, text: str) -> Any:
    try:
        value = extra("estimator.plain_files").parse(text, source)
    except ValueError as error:
        raise ValueError(f"{source}: the value cannot be read") from error
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return value
    return value


def run_name(log: str | os.PathLike[str]) -> str:
    """Name for the folder of a run that starts now: <record>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return f"{Path(log).name.partition('.')[0]}__{stamp}"
