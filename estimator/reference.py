"""Things of one's own by where they are: "module:attribute"."""

import importlib
from typing import Any


def is_reference(name: object) -> bool:
    """Whether a name says where something is, instead of what it is called."""
    return isinstance(name, str) and ":" in name


def referenced(name: str) -> Any:
    """What a reference stands for; its module is imported.

    Args:
        name: "module:attribute".

    Raises:
        ValueError: There is no such module or attribute; the message says which.
    """
    module, _, attribute = name.partition(":")
    try:
        return getattr(importlib.import_module(module), attribute)
    except (ModuleNotFoundError, AttributeError) as error:
        raise ValueError(f"{name!r}: {error}") from error
