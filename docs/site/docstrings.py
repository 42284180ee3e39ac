"""Extension of griffe: docstrings that are completed when a module is imported, as they then are."""

import inspect
from importlib import import_module
from typing import Any

import griffe


class Completed(griffe.Extension):
    """Replaces docstrings with a place for the arguments by those of the imported classes."""

    def on_class(self, *, cls: griffe.Class, **_: Any) -> None:
        """Called for every class that griffe has read."""
        if cls.docstring and "{arguments}" in cls.docstring.value:
            found = getattr(import_module(cls.module.path), cls.name)
            cls.docstring.value = inspect.getdoc(found) or ""
