"""Reads studies from YAML files."""

from __future__ import annotations

import os
from typing import Any

from policies.study.config import Study
from slipgym.config.yaml_model import names, read_model, validate
from slipgym.tasks import find

_FOLDER = "studies"


def study_names() -> list[str]:
    """Names of the studies that come with slipgym."""
    return names(_FOLDER)


def load_study(which: str | os.PathLike[str]) -> Study:
    """Reads a study: one of `study_names()`, or the YAML file at a path.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or the file holds a wrong key or value.
    """
    return read_model(which, Study, _FOLDER, "study")


def narrowed(study: Study, **changes: Any) -> Study:
    """The study with other values; what is None or empty stays. The degradation has no more episodes.

    Raises:
        ValueError: A value is not allowed.
    """
    given = {key: value for key, value in changes.items() if value not in (None, "", (), [])}
    if "tasks" in given:
        given["tasks"] = [find(task).name for task in given["tasks"]]
        given["videos"] = [task for task in study.videos if task in given["tasks"]]
    if "episodes" in given and study.degradation is not None:
        fewer = {"episodes": min(given["episodes"], study.degradation.episodes)}
        given["degradation"] = study.degradation.model_copy(update=fewer)
    return validate({**dict(study), **given}, Study, study.name)
