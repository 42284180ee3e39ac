"""Compiled functions whose source text is generated from a table, as `dataclasses` generates `__init__`.

A table row holds a name and the expression that computes its value. The generated writer stores row k at
place k, so that a name cannot come apart from its value.
"""

from __future__ import annotations

import hashlib
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
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

    The text is kept as `__source__` of the Python function, `generate(...).py_func.__source__`. Numba's disk
    cache compares neither constants nor names, so the function carries a digest of its text and its namespace
    as a closure variable, which the cache does compare.

    Args:
        name: Name of the function, unique among those that are generated for `file`.
        arguments: Names of its arguments.
        body: Lines of its body, indented relative to each other.
        namespace: Globals of the function: constants, modules and compiled functions that the body uses.
        decorator: Compiles it: `slipgym._numba.compiled.compiled` or `unlocked`.
        file: `__file__` of the module that declares the table; the compiled code is cached beside it.
        doc: Docstring.

    Returns:
        What the decorator returns.

    Raises:
        SyntaxError: The body is not Python; the message holds the line.
    """
    lines = [f"def {name}({', '.join(arguments)}):", f"    {doc!r}", "    _digest"]
    lines += textwrap.indent("\n".join(body), "    ").splitlines()
    source = "\n".join(lines) + "\n"
    factory = f"def _make(_digest):\n{textwrap.indent(source, '    ')}    return {name}\n"
    where = file if Path(file).is_file() else __file__
    made: dict[str, Any] = {**namespace, "__name__": namespace.get("__name__", __name__)}
    exec(compile(factory, where, "exec"), made)
    function = made["_make"](_digest(source, namespace))
    function.__qualname__ = name
    function.__source__ = source
    return decorator(function)


def _digest(source: str, namespace: Mapping[str, Any]) -> int:
    """Number that changes with the text, the constants and the files of the functions that it uses."""
    parts = [source]
    for key in sorted(namespace):
        if not key.startswith("__"):
            parts += [key, *_stamps(namespace[key])]
    return int.from_bytes(hashlib.sha256("\0".join(parts).encode()).digest()[:7], "big")


def _stamps(value: Any) -> Iterator[str]:
    function = getattr(value, "py_func", value)
    code = getattr(function, "__code__", None)
    if code is not None:
        yield code.co_qualname
        yield getattr(function, "__source__", "")
        path = Path(code.co_filename)
        if path.is_file():
            state = path.stat()
            yield f"{path}:{state.st_mtime_ns}:{state.st_size}"
    elif isinstance(value, (bool, int, float, str)):
        yield repr(value)
