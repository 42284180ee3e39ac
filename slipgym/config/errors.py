"""Formats validation errors: they name the place, the value and the valid values.

Bounds and names are read from the models' JSON schema, so that they are declared only in the models.
"""

import difflib
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from estimator import suggestions

SourceOf = Callable[[tuple[int | str, ...]], str]
"""Names the file or argument that a location in the configuration came from."""

NEEDS_TILT = 'needs config={"physics": {"tilt": True}} and engine="bullet"'
"""End of the messages about motions out of the contact plane."""

_LINES = 10
"""Faults that one error describes."""
_BOUNDS = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
_KINDS = {
    "number": "a finite number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "null",
    "object": "a mapping of names to values",
    "string": "a text",
    "array": "a list",
}


def unknown(what: str, name: object, valid: Iterable[str], also: Iterable[str] = ()) -> str:
    """`estimator.suggestions.unknown` of the names in order; a guess that is less alike stands at the end."""
    valid = sorted(valid)
    if difflib.get_close_matches(str(name)[:100], valid, n=1):
        return suggestions.unknown(f"unknown {what}", name, valid, also)
    said = f"unknown {what} {name!r:.100}; valid: {', '.join(valid)}"
    return suggestions.asking(said, name, [*valid, *also])


def explain(
    error: ValidationError, source_of: SourceOf, model: type[BaseModel], prefix: tuple[str, ...] = ()
) -> ValueError:
    """Turns pydantic's report into a ValueError with one line per fault.

    Args:
        error: The report of a failed ``model_validate``.
        source_of: Names the file or argument that a location in the configuration came from.
        model: The model that was validated.
        prefix: Location of the model in the whole configuration.
    """
    faults = error.errors()
    lines = [f"{source_of(e['loc'])}: {_describe(e, model, prefix)}" for e in faults[:_LINES]]
    if len(faults) > _LINES:
        lines.append(f"... and {len(faults) - _LINES} more")
    return ValueError("\n".join(lines))


def _describe(error: ErrorDetails, model: type[BaseModel], prefix: tuple[str, ...]) -> str:
    location = error["loc"]
    dotted = ".".join(f"{part!s:.80}" for part in (*prefix, *location))
    if location and location[-1] == "[key]":
        return f"{'.'.join(map(str, (*prefix, *location[:-2])))}: names must be text, got {error['input']!r}"
    if error["type"] in ("extra_forbidden", "invalid_key"):
        options = _Schema(model).options(_Schema(model).at(location[:-1]))
        keys = [key for option in options for key in option.get("properties", ())]
        return f"{dotted}: {unknown('key', location[-1], keys)}"
    if error["type"] == "value_error":
        message = error["msg"].removeprefix("Value error, ")
        return f"{dotted}: {message}" if dotted else message
    if error["type"].startswith("union_tag"):
        kinds = _Schema(model).at(location)["discriminator"]["mapping"]
        return f"{dotted}: {unknown('kind', error.get('ctx', {}).get('tag'), kinds)}"
    node = _Schema(model).at(location)
    allowed = _Schema(model).allowed(node)
    if error["type"] == "missing":
        return f"{dotted} is missing: must be {allowed}"
    names = map(str, node.get("enum", ()))
    said = f"{dotted} = {_shorten(error['input'])}: must be {allowed}"
    return suggestions.asking(said, error["input"], names) if isinstance(error["input"], str) else said


def _shorten(value: object) -> str:
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # a whole number of thousands of digits, or very deep nesting
        text = f"a very large {type(value).__name__}"
    return text if len(text) <= 80 else f"{text[:77]}..."


@cache
def _json_schema(model: type[BaseModel]) -> dict[str, Any]:
    return model.model_json_schema()


class _Schema:
    """The JSON schema of a model."""

    def __init__(self, model: type[BaseModel]) -> None:
        self._root = _json_schema(model)

    def at(self, location: tuple[int | str, ...]) -> dict[str, Any]:
        """The schema of a location in the model, or else of its deepest known parent."""
        node = self._root
        for part in location:
            children = [child for option in self.options(node) for child in _children(option, part)]
            if not children:
                break
            node = self._followed(children[0])
        return node

    def options(self, node: dict[str, Any]) -> list[dict[str, Any]]:
        """The alternatives of a schema; the schema itself if it has none."""
        return [self._followed(option) for option in node.get("anyOf", [node])]

    def allowed(self, node: dict[str, Any]) -> str:
        """Describe the values that a schema allows."""
        if "anyOf" in node:
            text = " or ".join(self.allowed(option) for option in self.options(node))
        elif "enum" in node:
            text = "one of " + ", ".join(repr(value) for value in node["enum"])
        elif "prefixItems" in node:
            items = [self.allowed(item) for item in node["prefixItems"]]
            text = f"a list of {len(items)}: each {items[0]}"
        elif "discriminator" in node:
            text = "one of the kinds " + ", ".join(node["discriminator"]["mapping"])
        elif "items" in node:
            least = f" of at least {node['minItems']}" if "minItems" in node else ""
            text = f"a list{least}: each {self.allowed(self._followed(node['items']))}"
        else:
            bounds = " and ".join(f"{sign} {node[key]:g}" for key, sign in _BOUNDS.items() if key in node)
            pattern = f"that matches {node['pattern']}" if "pattern" in node else ""
            kind = _KINDS[node["type"]] if "type" in node else "any value"
            text = " ".join(filter(None, [kind, pattern, bounds]))
        return f"{text} ({node['description']})" if "description" in node else text

    def _followed(self, node: dict[str, Any]) -> dict[str, Any]:
        """The schema that a reference points to; other schemas unchanged."""
        if "$ref" not in node:
            return node
        return self._root["$defs"][node["$ref"].rpartition("/")[2]]


def _children(node: dict[str, Any], part: int | str) -> list[dict[str, Any]]:
    """The schema of one part of a schema, if there is one."""
    child = node.get("properties", {}).get(part) or node.get("additionalProperties")
    if "prefixItems" in node and isinstance(part, int) and part < len(node["prefixItems"]):
        child = node["prefixItems"][part]
    elif "items" in node and isinstance(part, int):
        child = node["items"]
    elif part in node.get("discriminator", {}).get("mapping", {}):
        child = {"$ref": node["discriminator"]["mapping"][part]}
    return [child] if isinstance(child, dict) else []
