"""Looks up an object by a "module:attribute" reference."""

import importlib
from typing import Any


def is_reference(name: object) -> bool:
    """Whether a name is a "module:attribute" reference rather than a registered name."""
    return isinstance(name, str) and ":" in name


def referenced(name: str) -> Any:
    """The object of a reference "module:attribute", whose module is imported.

    Raises:
        ValueError: There is no such module or attribute; the message says which.
    """
    module, _, attribute = name.partition(":")
    try:
        imported = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module.partition(".")[0] and not module.endswith(".py"):
            raise ValueError(f"{name!r}: {error}") from error
        remedy = f"write {module.removesuffix('.py').replace('/', '.')}:{attribute}, and " * module.endswith(
            ".py"
        )
        raise ValueError(
            f"{name!r}: no module {module!r} on Python's path; {remedy}add its folder to PYTHONPATH"
        ) from error
    if not hasattr(imported, attribute):
        raise ValueError(f"{name!r}: module {module!r} has no attribute {attribute!r}")
    return getattr(imported, attribute)
