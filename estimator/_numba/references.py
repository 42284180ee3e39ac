"""Removes the counting of references to the arguments of compiled functions.

Numba counts a reference to an array wherever a view of it begins or ends, with an atomic operation. A caller
keeps its arguments alive during a call, so in a function these counts of an argument add up to nothing. A
step of an environment would otherwise make dozens of them.

Source: numba itself edits a program's text in this way, see `numba.core.runtime.nrtopt`.
"""

from __future__ import annotations

import re
from typing import Any

from llvmlite import binding

_NAME = r'%(?:"[^"]*"|[-\w$.]+)'
_FUNCTION = re.compile(r"^define [^\n]*\{\n.*?^\}", re.MULTILINE | re.DOTALL)
_COUNT = re.compile(
    rf"^ *(?:tail )?call void @NRT_(?:inc|dec)ref\(ptr (?:[a-z]+(?:\([^)]*\))? )*({_NAME}|null)\).*\n",
    re.MULTILINE,
)
_CHOICE = re.compile(r"(?:phi ptr|select i1) (.*)")
_PASSED_ON = re.compile(
    rf"^ *({_NAME}) = (?:insertvalue|extractvalue|phi|select|freeze|ptrtoint) (.*)", re.MULTILINE
)
_KEPT = re.compile(r"^ *(?:store|ret) .*", re.MULTILINE)


def without_counts_of_arguments(module: Any) -> Any:
    """An optimised module whose functions do not count references to their own arguments.

    Functions that store or return an argument, or count a reference whose origin is not plain, stay as they
    are.

    Args:
        module: LLVM module; it stays as it is.
    """
    text = str(module)
    edited = _FUNCTION.sub(lambda match: _edited(match[0]), text)
    if edited == text:
        return module
    changed = binding.parse_assembly(edited)
    changed.name = module.name
    return changed


def _edited(function: str) -> str:
    """The text of a function without the counts, or unchanged."""
    head, body = function.split("\n", 1)
    counts = _COUNT.findall(body)
    if len(counts) != len(re.findall(r"@NRT_(?:inc|dec)ref\b", body)):  # one that is not understood
        return function
    counted = set(counts)
    arguments = set(re.findall(_NAME, head.partition("(")[2]))
    if not counted & arguments:
        return function
    borrowed = {"null", *arguments}
    for name in sorted(counted - borrowed):
        origin = _origin(name, body)
        choice = _CHOICE.match(origin)
        if choice is not None:  # of values that one of several paths leads to
            if not _values(origin, choice[1]) <= borrowed:
                return function
            borrowed.add(name)
        elif not re.match(r"(?:tail )?call .*@NRT_MemInfo_alloc", origin):
            return function
    tracked = _followed((counted & borrowed) - {"null"}, body)
    if any(tracked & set(re.findall(_NAME, line)) for line in _KEPT.findall(body)):
        return function
    return head + "\n" + _COUNT.sub(lambda match: "" if match[1] in borrowed else match[0], body)


def _followed(names: set[str], body: str) -> set[str]:
    """Some values, and all values that may be or contain one of them."""
    operations = [(name, set(re.findall(_NAME, rest))) for name, rest in _PASSED_ON.findall(body)]
    found, before = set(names), 0
    while len(found) > before:
        before = len(found)
        found |= {name for name, parts in operations if parts & found}
    return found


def _origin(name: str, body: str) -> str:
    """The operation that a value is the result of."""
    found = re.search(rf"^ *{re.escape(name)} = (.*)", body, re.MULTILINE)
    return "" if found is None else found[1]


def _values(origin: str, rest: str) -> set[str]:
    """Values that a `phi` or a `select` chooses from."""
    value = rf"({_NAME}|[\w.]+)"
    pattern = rf"\[ {value}, " if origin.startswith("phi") else rf", ptr {value}"
    return set(re.findall(pattern, rest))
