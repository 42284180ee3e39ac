"""Things of one's own by where they are: "module:attribute"."""

import importlib
from typing import Any


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
