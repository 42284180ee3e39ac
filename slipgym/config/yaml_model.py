"""Reads a YAML file into a validated model, with errors that name the file, the key and what is valid."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from estimator.suggestions import yaml_beside
from slipgym.config import files
from slipgym.config.errors import SourceOf, explain, unknown

Choice = str | os.PathLike[str] | Mapping[str, Any]
"""The name of a file that comes with slipgym, the path of a YAML file, or a mapping of the same shape."""
M = TypeVar("M", bound=BaseModel)


def names(folder: str) -> list[str]:
    """Names of the YAML files in a folder of the default configuration, such as "randomization"."""
    return sorted(path.stem for path in (files.folder() / folder).glob("*.yaml"))


def read_model(
    choice: Choice, model: type[M], folder: str, kind: str, context: Mapping[str, Any] | None = None
) -> M:
    """Reads a model.

    Args:
        choice: One of `names(folder)`, the path of a YAML file, or a mapping of the same shape.
        model: The class to validate against.
        folder: Folder of the default configuration whose files go by name.
        kind: Name of the kind of model in error messages, "experiment" for example.
        context: Passed to the model's validators.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or a key or value is wrong; a line for each fault names its place and
            the valid values.
    """
    values, source, name = chosen(choice, kind, names(folder))
    if name:
        path = files.folder() / folder / f"{name}.yaml"
        values, source = files.read_once(path), os.fspath(path)
    return validate(values, model, source, context)


def file_content(choice: Any) -> Any:
    """Reads a choice that is the path of a YAML file, so that a path need not be kept; returns others as is.

    Raises:
        FileNotFoundError: The file does not exist.
        ValueError: It holds no mapping.
    """
    return files.read(Path(choice)) if _is_file(choice) else choice


def _is_file(choice: Any) -> bool:
    return isinstance(choice, str | os.PathLike) and Path(choice).suffix in (".yaml", ".yml")


def chosen(
    choice: Choice, kind: str, valid: Collection[str], of: str = ""
) -> tuple[Mapping[str, Any], str, str]:
    """The values of a choice and their origin, for error messages; or its name, one of the valid ones.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: It is of another type, or the name is unknown, that of a `kind` and `of` what.
    """
    if isinstance(choice, Mapping):
        files.check_size(choice, f"{kind} argument")
        return choice, f"{kind} argument", ""
    if not isinstance(choice, str | os.PathLike):
        raise ValueError(
            f"{kind} = {choice!r} must be a name, a path or a mapping; names: {', '.join(valid)}"
        )
    path = Path(choice)
    if _is_file(choice):
        return files.read(path), os.fspath(path), ""
    if str(choice) not in valid:
        raise ValueError(unknown(f"{kind}{of}", str(choice), valid, yaml_beside(path)))
    return {}, "", str(choice)


def validate(
    values: Mapping[str, Any],
    model: type[M],
    source: str | SourceOf,
    context: Mapping[str, Any] | None = None,
    prefix: tuple[str, ...] = (),
) -> M:
    """Makes a model from plain values.

    Args:
        values: As in a YAML file.
        model: The class to validate against.
        source: Origin of the values, for error messages; or a function that returns it for a key's location.
        context: Passed to the model's validators.
        prefix: Location of the model in a larger document, for error messages.

    Raises:
        ValueError: A key or value is wrong; a line for each fault.
    """
    source_of = source if callable(source) else lambda _: source
    try:
        return model.model_validate(dict(values), context=context)
    except ValidationError as error:
        raise explain(error, source_of, model, prefix) from error
