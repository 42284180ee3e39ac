"""Finds and reads YAML files."""

import re
from functools import cache
from pathlib import Path
from typing import Any

import yaml

_PACKAGE = Path(__file__).resolve().parents[1]
_YAML_1_2_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$")


@cache
def folder() -> Path:
    """The folder of the default files: inside the package when installed, beside it in a source checkout."""
    packaged = _PACKAGE / "configs"
    return packaged if packaged.is_dir() else _PACKAGE.parent / "configs"


def read(path: Path) -> dict[str, Any]:
    """Reads one YAML file, safely.

    Args:
        path: The file.

    Returns:
        Its top-level mapping; empty for an empty file.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is not YAML, holds a key twice, or is not a mapping.
    """
    data = parse(path.read_bytes(), str(path))
    if data is None:
        return {}
    if not isinstance(data, dict):
        raise ValueError(f"{path}: must be a mapping of names to values, got {type(data).__name__}")
    return data


def parse(text: str | bytes, source: str) -> Any:
    """Reads a YAML text, safely.

    Args:
        text: The text.
        source: Origin of the text, for error messages.

    Raises:
        ValueError: It is not YAML, or holds a key twice.
    """
    try:
        loader = _Loader(text)
        loader.name = Path(source).name
        return loader.get_single_data()
    except yaml.YAMLError as error:
        raise ValueError(f"{source}: {error}") from error


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader that refuses a key given twice and reads 1e-3 as the number it is in YAML 1.2."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                continue
            if key.value in seen:
                raise yaml.MarkedYAMLError(
                    problem=f"duplicate key {key.value!r}", problem_mark=key.start_mark
                )
            seen.add(key.value)
        return super().construct_mapping(node, deep)


_Loader.add_implicit_resolver("tag:yaml.org,2002:float", _YAML_1_2_FLOAT, list("-+.0123456789"))
