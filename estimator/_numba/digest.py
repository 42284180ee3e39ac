"""Identifies a compiled function by what is compiled: its module, byte code, constants and all that it calls.

Comments, docstrings, annotations, line numbers and file times do not count. What is compiled is found as
numba finds it: a name in the byte code is looked up in the globals and the closure of the function.
"""

from __future__ import annotations

import ast
import enum
import hashlib
import importlib
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher

_VERSIONED = {*sys.stdlib_module_names, "numpy", "numba", "llvmlite"}
"""Packages that change with their version only, which the cache compares."""
_LINKER = Path(__file__).with_name("linking.py")
"""The file that decides what becomes of compiled functions: an edit of it makes other programs."""
_PLAIN = bool, int, float, complex, str, bytes, type(None), enum.Enum, np.generic, np.ndarray, np.dtype
_ARGUMENT_FLAGS = 0x2F
"""Flags of a code object that say how it takes arguments and whether it is a generator."""


@cache
def digest(function: Any) -> str:
    """Hash of a dispatcher of numba and of all compiled functions, constants and types that it uses."""
    hashed = hashlib.sha256(_LINKER.read_bytes())
    places: dict[int, int] = {}
    waiting: list[Any] = [function]
    while waiting:
        dispatcher = waiting.pop()
        text, called = _parts(dispatcher)
        hashed.update(text.encode())
        for other in called:
            if id(other) not in places:
                places[id(other)] = len(places)
                waiting.append(other)
            hashed.update(f" {places[id(other)]}".encode())
    return hashed.hexdigest()


@cache
def _parts(dispatcher: Any) -> tuple[str, tuple[Any, ...]]:
    """Text of a function's own part, and the dispatchers that it uses, in the order of its text."""
    function = dispatcher.py_func
    # a stored program names the modules of its functions, and cannot be read without them
    texts = [repr(function.__module__), *_flat(dispatcher.targetoptions)]
    called: list[Any] = []
    names: list[str] = []
    texts += _code(function.__code__, names)
    closure = {
        name: cell.cell_contents
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True)
    }
    for value in (function.__defaults__, function.__kwdefaults__):
        texts += _flat(value)
    for name in dict.fromkeys([*names, *closure]):
        for scope in (closure, function.__globals__):
            if name in scope:
                for part in _uses(scope[name], names):
                    texts.append(part if isinstance(part, str) else f"{name}: {part.py_func.__qualname__}")
                    if not isinstance(part, str):
                        called.append(part)
                break
    return "\0".join(texts), tuple(called)


def _code(code: CodeType, names: list[str]) -> Iterator[str]:
    """Texts of a code object without its docstring; its names are appended to `names`."""
    yield code.co_code.hex()
    yield repr((code.co_flags & _ARGUMENT_FLAGS, code.co_argcount, code.co_posonlyargcount))
    yield repr((code.co_kwonlyargcount, code.co_varnames, code.co_names, code.co_freevars, code.co_cellvars))
    yield getattr(code, "co_exceptiontable", b"").hex()
    names += code.co_names
    for k, constant in enumerate(code.co_consts):
        if isinstance(constant, CodeType):
            yield from _code(constant, names)
        elif k > 0 or not isinstance(constant, str):  # the first constant may be the docstring
            yield from _flat(constant)


def _uses(value: Any, names: list[str]) -> Iterator[Any]:
    """Texts of a global value, and the dispatchers in it; of a module, those of its `names`."""
    if isinstance(value, Dispatcher):
        yield value
    elif isinstance(value, ModuleType):
        yield value.__name__
        if value.__name__.partition(".")[0] not in _VERSIONED:
            for name in dict.fromkeys(names):
                attribute = getattr(value, name, None)
                if attribute is not None and not isinstance(attribute, ModuleType):
                    yield from _uses(attribute, names)
    elif isinstance(value, tuple):
        yield f"{type(value).__qualname__} {len(value)}"
        for item in value:
            yield from _uses(item, names)
    elif isinstance(value, _PLAIN):
        yield from _flat(value)
    else:  # a Python function with overloads, an intrinsic, a class
        module = getattr(value, "__module__", None) or type(value).__module__
        yield f"{module}.{getattr(value, '__qualname__', repr(type(value)))}"
        if module.partition(".")[0] not in _VERSIONED:
            text, dispatchers = _module(module)
            yield text
            yield from dispatchers


def _flat(value: Any) -> Iterator[str]:
    """Texts that tell constants apart: all digits of numbers, contents of arrays, layouts of records."""
    yield type(value).__qualname__
    if isinstance(value, Mapping):
        for key in sorted(value):
            yield key
            yield from _flat(value[key])
    elif isinstance(value, (set, frozenset)):
        yield from sorted(map(repr, value))
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from _flat(item)
    elif isinstance(value, (np.ndarray, np.generic)):
        yield f"{value.dtype!r} {value.shape}"
        yield value.tobytes().hex()
    else:
        yield repr(value)


@cache
def _module(name: str) -> tuple[str, tuple[Any, ...]]:
    """Text of a module without docstrings, comments and annotations, and the dispatchers among its names."""
    module = sys.modules.get(name) or importlib.import_module(name)
    file = getattr(module, "__file__", None)
    if file is None or not Path(file).is_file():
        return "", ()
    tree = ast.parse(Path(file).read_bytes())
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node, False):
            node.body = node.body[1:]
        if isinstance(node, ast.FunctionDef):
            node.returns = None
        elif isinstance(node, ast.arg):
            node.annotation = None
    return ast.dump(tree), tuple(value for value in vars(module).values() if isinstance(value, Dispatcher))
