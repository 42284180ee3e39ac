"""Compiled functions whose source text is generated from a table, as `dataclasses` generates `__init__`.

A table row holds a name and the expression that computes its value. The generated writer stores row k at
place k, so that a name cannot come apart from its value.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any


def generate(
    name: str,
    arguments: Sequence[str],
    body: Sequence[str],
    namespace: Mapping[str, Any],
    decorator: Callable[[Any], Any],
    file: str,
    doc: str,
) -> Any:
    """Build a function from source text and compile it.

    The text is kept as `__source__` of the Python function, `generate(...).py_func.__source__`.

    Args:
        name: Name of the function, unique among those that are generated for `file`.
        arguments: Names of its arguments.
        body: Lines of its body, indented relative to each other.
        namespace: Globals of the function: constants, modules and compiled functions that the body uses.
        decorator: Compiles it; what it returns is returned.
        file: `__file__` of the module that declares the table; the compiled code is cached beside it.
        doc: Docstring.

    Raises:
        SyntaxError: The body is not Python; the message holds the line.
    """
    lines = [f"def {name}({', '.join(arguments)}):", f"    {doc!r}"]
    lines += textwrap.indent("\n".join(body), "    ").splitlines()
    source = "\n".join(lines) + "\n"
    where = file if Path(file).is_file() else __file__
    made: dict[str, Any] = {**namespace, "__name__": namespace.get("__name__", __name__)}
    exec(compile(source, where, "exec"), made)
    function = made[name]
    function.__source__ = source
    return decorator(function)
