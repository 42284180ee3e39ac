"""Finds and reads YAML files."""

from collections.abc import Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from estimator.plain_files import DEPTH, NODES, content, parse

__all__ = ["check_size", "folder", "parse", "read", "read_once"]

_PACKAGE = Path(__file__).resolve().parents[1]


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
        ValueError: It is no regular file, too large, not YAML, holds a key twice, or is not a mapping.
    """
    data = parse(content(path), str(path))
    if data is None:
        return {}
    if not isinstance(data, dict):
        raise ValueError(f"{path}: must be a mapping of names to values, got {type(data).__name__}")
    return data


def read_once(path: Path) -> dict[str, Any]:
    """As `read`; a file that has not changed is not read again, and the result must not be changed."""
    now = path.stat()
    return _read_once(path, now.st_mtime_ns, now.st_size)


@lru_cache(maxsize=256)
def _read_once(path: Path, *_: int) -> dict[str, Any]:
    return read(path)


def check_size(values: Mapping[Any, Any], source: str) -> None:
    """Raise ValueError if a mapping is nested too deep, or in itself, or holds too many values.

    Args:
        values: The mapping, of mappings, lists and plain values.
        source: Its origin, for the message.
    """
    level: list[Any] = [values]
    count = 0
    for _ in range(DEPTH):
        count += len(level)
        if count > NODES:
            raise ValueError(f"{source}: holds more than {NODES} values")
        inner: list[Any] = []
        for value in level:
            if isinstance(value, Mapping):
                inner.extend(value.values())
            elif isinstance(value, list | tuple):
                inner.extend(value)
        if not inner:
            return
        level = inner
    raise ValueError(f"{source}: is nested deeper than {DEPTH} levels")
