"""Error messages that say where, what, and what would have been right.

Bounds and names are read from the models' JSON schema, so they are written down once: in the models.
"""

import difflib
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from slipgym.config.root import Config

SourceOf = Callable[[tuple[int | str, ...]], str]
"""Names the file or argument that a location in the configuration came from."""

_BOUNDS = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
_KINDS = {
    "number": "a finite number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "null",
    "object": "a mapping of names to values",
    "string": "a text",
}


def unknown(what: str, name: object, valid: Iterable[str]) -> str:
    """The message for a name that is not one of the valid ones, with a guess at the one that was meant."""
    valid = sorted(valid)
    close = difflib.get_close_matches(str(name), valid, n=1)
    guess = f"did you mean {close[0]!r}? " if close else ""
    return f"unknown {what} {name!r}; {guess}valid: {', '.join(valid)}"


def explain(error: ValidationError, source_of: SourceOf) -> ValueError:
    """Turns pydantic's report into a ValueError with one line per fault.

    Args:
        error: The report of a failed ``Config.model_validate``.
        source_of: Names the file or argument that a location in the configuration came from.
    """
    return ValueError("\n".join(f"{source_of(e['loc'])}: {_describe(e)}" for e in error.errors()))


def _describe(error: ErrorDetails) -> str:
    location = error["loc"]
    dotted = ".".join(str(part) for part in location)
    if location and location[-1] == "[key]":
        return f"{'.'.join(map(str, location[:-2]))}: names must be text, got {error['input']!r}"
    if error["type"] in ("extra_forbidden", "invalid_key"):
        options = _options(_schema_at(location[:-1]))
        keys = [key for option in options for key in option.get("properties", ())]
        return f"{dotted}: {unknown('key', location[-1], keys)}"
    if error["type"] == "value_error":
        message = error["msg"].removeprefix("Value error, ")
        return f"{dotted}: {message}" if dotted else message
    if error["type"] == "missing":
        return f"{dotted} is missing: must be {_allowed(_schema_at(location))}"
    return f"{dotted} = {_shorten(error['input'])}: must be {_allowed(_schema_at(location))}"


def _shorten(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


@cache
def _schema() -> dict[str, Any]:
    return Config.model_json_schema()


def _schema_at(location: tuple[int | str, ...]) -> dict[str, Any]:
    """The JSON schema of one place in the configuration; of the deepest known one above it otherwise."""
    node = _schema()
    for part in location:
        children = [child for option in _options(node) for child in _children(option, part)]
        if not children:
            break
        node = _followed(children[0])
    return node


def _children(node: dict[str, Any], part: int | str) -> list[dict[str, Any]]:
    """The schema that a JSON schema has for one of its parts, if any."""
    child = node.get("properties", {}).get(part) or node.get("additionalProperties")
    if "prefixItems" in node and isinstance(part, int) and part < len(node["prefixItems"]):
        child = node["prefixItems"][part]
    return [child] if isinstance(child, dict) else []


def _options(node: dict[str, Any]) -> list[dict[str, Any]]:
    """The alternatives of a JSON schema; itself if it has none."""
    return [_followed(option) for option in node.get("anyOf", [node])]


def _followed(node: dict[str, Any]) -> dict[str, Any]:
    """What a JSON schema refers to; itself if it is no reference."""
    return _schema()["$defs"][node["$ref"].rpartition("/")[2]] if "$ref" in node else node


def _allowed(schema: dict[str, Any]) -> str:
    """Says which values a JSON schema allows."""
    if "anyOf" in schema:
        text = " or ".join(_allowed(option) for option in _options(schema))
    elif "enum" in schema:
        text = "one of " + ", ".join(repr(value) for value in schema["enum"])
    elif "prefixItems" in schema:
        items = [_allowed(item) for item in schema["prefixItems"]]
        text = f"a list of {len(items)}: each {items[0]}"
    else:
        bounds = " and ".join(f"{sign} {schema[key]:g}" for key, sign in _BOUNDS.items() if key in schema)
        text = " ".join([_KINDS[schema["type"]], bounds]).strip()
    return f"{text} ({schema['description']})" if "description" in schema else text
