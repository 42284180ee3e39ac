"""Reads name, unit and meaning of a record's fields from its declaration, where comments say them."""

import ast
import inspect
import re
from collections.abc import Iterator
from types import ModuleType

import numpy as np

from slipgym.tasks import disturbance, episode
from slipgym.world import records

DECLARED = {
    "episode": (episode.EPISODE, (episode, "EPISODE"), (disturbance, "FIELDS")),
    "world": (records.WORLD, (records, "WORLD")),
    "fingers[f]": (records.FINGER, (records, "FINGER")),
}
"""What a task's functions call a record -> its type, and the declarations of its fields."""
FIELD = re.compile(r'\s*\("(\w+)", ".*\),  # (.+)$')
UNIT = re.compile(r"\s*\[([^]]+)\](?:,(?=\s*\[))?")


def comments(module: ModuleType, name: str) -> dict[str, str]:
    """Field -> comment, in the declaration of a name and of its parts: FINGER_STATE is one of FINGER."""
    source = inspect.getsource(module)
    found = {}
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and re.match(rf"{name}(_|$)", ast.unparse(node.targets[0])):
            lines = source.splitlines()[node.lineno - 1 : node.end_lineno]
            found |= {match[1]: match[2] for match in map(FIELD.match, lines) if match}
    return found


def rows() -> Iterator[tuple[str, str, str]]:
    """Field, unit and meaning, for each field of all records.

    Raises:
        KeyError: A field has no comment.
    """
    for record, (dtype, *places) in DECLARED.items():
        said = {field: text for place in places for field, text in comments(*place).items()}
        for name in dtype.names or ():
            shape = ", ".join(map(str, dtype[name].shape))
            number = np.issubdtype(dtype[name].base, np.floating)
            unit = "; ".join(UNIT.findall(said[name])) or ("" if number else "-")
            meaning = UNIT.sub("", said[name]).strip(" ,") or name.replace("_", " ")
            yield f"`{record}.{name}`" + (f" ({shape})" if shape else ""), unit, meaning
