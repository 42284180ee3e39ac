"""Loads configurations: merges defaults, a sensor preset and the user's overrides, and validates them."""

import os
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator

from slipgym.config import files
from slipgym.config.errors import unknown
from slipgym.config.randomization import Randomization
from slipgym.config.root import Config
from slipgym.config.yaml_model import file_content, read_model, validate
from slipgym.config.yaml_model import names as names_in

Overrides = str | os.PathLike[str] | Mapping[str, Any]
Content = Annotated[Mapping[str, Any], BeforeValidator(lambda given: content(given))]
"""Overrides of a model that is plain data: a mapping, or a file that becomes one."""


def load(
    overrides: Overrides | None = None,
    sensors: str = "realistic",
    contact: str | None = None,
    box: Mapping[str, Any] | None = None,
) -> Config:
    """Loads the configuration of an environment, without the settings of its task.

    Args:
        overrides: Values that replace defaults, as a mapping or as the path of a YAML file; merged key by
            key, at every depth. Lists are replaced as a whole. A group "tasks" is left to
            `slipgym.tasks.configure`.
        sensors: The sensor preset to start from, one of ``names("sensors")``.
        contact: The friction model to start from, one of `slipgym.config.physics.ContactModel`; None: the
            default one.
        box: Values of the group "object" that stand in place of the defaults; None: none.

    Raises:
        FileNotFoundError: The overrides' file does not exist.
        ValueError: A key is unknown or a value is not allowed. The message names the file or argument, the
            dotted key, the value, and the valid values.
    """
    if sensors not in names("sensors"):
        raise ValueError(unknown("sensors", sensors, names("sensors")))
    defaults, config = _files(sensors)
    if contact is not None:
        defaults = merge(defaults, {"contact": {"model": contact}})
        config = validate(defaults, Config, "contact argument")
    if box is not None:
        defaults = merge(defaults, {"object": box})
    if overrides is None:
        return config
    source, values = read_overrides(overrides)
    common = {key: value for key, value in values.items() if key != "tasks"}
    return validate(merge(defaults, common), Config, source)


def read_overrides(overrides: Overrides) -> tuple[str, Mapping[str, Any]]:
    """Return the origin of overrides, for error messages, and the overrides as a mapping.

    Raises:
        FileNotFoundError: The overrides' file does not exist.
        ValueError: They are neither a mapping nor a path.
    """
    if isinstance(overrides, Mapping):
        files.check_size(overrides, "config argument")
        return "config argument", overrides
    if isinstance(overrides, str | os.PathLike):
        return os.fspath(overrides), files.read(Path(overrides))
    raise ValueError(f"config argument: must be a mapping or a path, got {overrides!r}")


def content(overrides: Any) -> Any:
    """The content of overrides that are a path, so that what keeps them does not depend on the file."""
    return read_overrides(overrides)[1] if isinstance(overrides, str) else overrides


def randomization_content(choice: Any) -> Any:
    """A preset's name or a mapping as it is; the content of a file, so that a path need not be kept.

    Raises:
        FileNotFoundError, ValueError: As those of `load_randomization`.
    """
    load_randomization(choice)
    return file_content(choice)


def load_randomization(choice: Overrides = "none", tasks: Iterable[str] | None = None) -> Randomization:
    """Loads a randomization: the distributions that every episode is sampled from.

    Args:
        choice: A preset, one of ``names("randomization")``, the path of a YAML file, or a mapping of the same
            shape.
        tasks: Keys that the group "tasks" may have; None: any.

    Raises:
        FileNotFoundError: The file does not exist.
        ValueError: The preset or a key is unknown, or a value is not allowed. The message names the file or
            argument, the dotted key, the value, and the valid values.
    """
    return read_model(choice, Randomization, "randomization", "randomization", {"tasks": tasks})


def names(kind: str) -> tuple[str, ...]:
    """Names of the materials ("materials") or of the presets ("sensors", "randomization") in the defaults.

    Raises:
        ValueError: The kind is unknown.
    """
    if kind == "materials":
        return tuple(sorted(files.read(files.folder() / "materials.yaml")))
    if kind in ("sensors", "randomization"):
        return tuple(names_in(kind))
    raise ValueError(unknown("kind of name", kind, ["materials", "sensors", "randomization"]))


@cache
def _files(sensors: str) -> tuple[dict[str, Any], Config]:
    """Values of the files, and the configuration that they are."""
    sources = {"materials": "materials.yaml", "sensors": f"sensors/{sensors}.yaml"}
    values = files.read(files.folder() / "default.yaml")
    values |= {key: files.read(files.folder() / name) for key, name in sources.items()}

    def source(location: tuple[str | int, ...]) -> str:
        return str(files.folder() / sources.get(str(location[0]) if location else "", "default.yaml"))

    return values, validate(values, Config, source)


def merge(base: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Merge a mapping into another, key by key, at every depth."""
    merged = dict(base)
    for key, value in overrides.items():
        if isinstance(value, Mapping):
            old = merged.get(key)
            value = merge(old if isinstance(old, Mapping) else {}, value)
        merged[key] = value
    return merged
