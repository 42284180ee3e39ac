"""Names the folder of a run and writes where its results come from."""

from __future__ import annotations

import os
from datetime import datetime
from pathlib import Path
from typing import Any

import yaml

from policies.versions import write_versions
from slipgym import atomic_io

INCOMPLETE = "INCOMPLETE"
"""File in the folder of a run that is not over."""


def stamped(output: str | os.PathLike[str], name: str) -> Path:
    """A folder's path that says what it holds and when it was begun: <output>/<name>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return Path(output).expanduser().resolve() / f"{name}__{stamp}"


def write_origin(folder: Path, **documents: Any) -> None:
    """Writes plain values as YAML files of these names, such as the experiment, and the versions."""
    for name, values in documents.items():
        text = yaml.safe_dump(values, sort_keys=False, allow_unicode=True)
        atomic_io.write(folder / f"{name}.yaml", text.encode())
    write_versions(folder)
