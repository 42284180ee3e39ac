"""Extension of griffe: docstrings that are completed when a module is imported, as they then are."""

import dataclasses
import inspect
from importlib import import_module
from typing import Any

import griffe

HEAD = "| name | default | unit | range | meaning |\n|---|---|---|---|---|\n"


class Completed(griffe.Extension):
    """Replaces docstrings with a place for the arguments; adds the table of an estimator's parameters."""

    def on_class(self, *, cls: griffe.Class, **_: Any) -> None:
        """Called for every class that griffe has read."""
        if cls.docstring and "{arguments}" in cls.docstring.value:
            found = getattr(import_module(cls.module.path), cls.name)
            cls.docstring.value = inspect.getdoc(found) or ""
        elif cls.docstring and cls.module.path.startswith("estimator.") and cls.name.endswith("Parameters"):
            found = getattr(import_module(cls.module.path), cls.name)
            summary, _, rest = cls.docstring.value.partition("\n\n")
            cls.docstring.value = f"{summary}\n\n{parameter_table(found)}\n{rest}"


def parameter_table(parameters: type) -> str:
    """Markdown table of the fields of a dataclass that `estimator.parameters.parameter` declared."""
    rows = []
    for field in dataclasses.fields(parameters):
        default = f"{field.default:.4g}" if isinstance(field.default, float) else str(field.default)
        unit, within, doc = (field.metadata[key] for key in ("unit", "within", "doc"))
        rows.append(f"| `{field.name}` | {default} | {unit} | {within} | {doc} |\n")
    return HEAD + "".join(rows)
