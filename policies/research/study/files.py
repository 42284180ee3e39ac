"""Studies as YAML files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from policies.evaluation.files import validated
from policies.research.study.config import Study
from slipgym.config import files
from slipgym.config.errors import unknown


def study_names() -> list[str]:
    """Names of the studies that come with slipgym."""
    return sorted(path.stem for path in (files.folder() / "studies").glob("*.yaml"))


def load_study(which: str | os.PathLike[str]) -> Study:
    """Reads a study.

    Args:
        which: One of `study_names()`, or the path of a YAML file.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or the file holds a wrong key or value.
    """
    path = Path(which)
    if path.suffix not in (".yaml", ".yml"):
        if str(which) not in study_names():
            raise ValueError(unknown("study", str(which), study_names()))
        path = files.folder() / "studies" / f"{which}.yaml"
    return checked(files.read(path), path.name)


def narrowed(study: Study, **changes: Any) -> Study:
    """The study with other values; what is None or empty stays. What gets worse has no more episodes.

    Raises:
        ValueError: A value is not allowed.
    """
    given = {key: value for key, value in changes.items() if value not in (None, "", (), [])}
    if "tasks" in given:
        given["videos"] = [task for task in study.videos if task in given["tasks"]]
    if "episodes" in given and study.degradation is not None:
        fewer = {"episodes": min(given["episodes"], study.degradation.episodes)}
        given["degradation"] = study.degradation.model_copy(update=fewer)
    return checked({**dict(study), **given}, study.name)


def checked(values: Mapping[str, Any], source: str) -> Study:
    """A study from plain values.

    Args:
        values: As in a YAML file.
        source: Where they come from, for the message of an error.

    Raises:
        ValueError: A key or value is wrong; one line per fault says where and what is valid.
    """
    return validated(Study, values, source)
