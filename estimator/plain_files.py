"""Reads files of unknown origin: regular files of bearable size, and YAML of bearable complexity."""

from __future__ import annotations

import errno
import re
import stat
from pathlib import Path
from typing import Any

import yaml

from estimator.suggestions import brief, no_file

BYTES = 2**20
"""Largest YAML file."""
NODES = 20_000
"""Most values of a YAML file, each alias counted with all that it stands for."""
DEPTH = 64
"""Deepest nesting of a YAML file, aliases included."""
DIGITS = 100
"""Most characters of a number or date."""
_MESSAGE = 500
"""Most characters of a message of PyYAML, which may quote all of a file."""
_NUMBERS = tuple(f"tag:yaml.org,2002:{kind}" for kind in ("int", "float", "timestamp"))
_YAML_1_2_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$")


def check_regular(path: Path) -> None:
    """Raise ValueError if something is at a path that is no regular file: a folder, a pipe, a device.

    Raises:
        FileNotFoundError: Nothing is there, or nothing can be: the name is too long.
    """
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        raise FileNotFoundError(no_file(path)) from None
    except OSError as error:
        if error.errno != errno.ENAMETOOLONG:
            raise
        text = str(path)
        raise FileNotFoundError(f"{text[:80]}…: a path of {len(text)} characters is too long") from None
    if not stat.S_ISREG(mode):
        raise ValueError(f"{path}: is no regular file")


def content(path: Path, limit: int = BYTES) -> bytes:
    """All of a regular file that has at most `limit` bytes.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is no regular file, or larger.
    """
    check_regular(path)
    with path.open("rb") as stream:
        data = stream.read(limit + 1)
    if len(data) > limit:
        raise ValueError(f"{path}: is larger than the {limit} bytes allowed")
    return data


def parse(text: str | bytes, source: str) -> Any:
    """Reads a YAML text: numbers, texts, dates, lists and mappings alone; messages name its source.

    Raises:
        ValueError: It is not YAML, holds a key twice, or is too large, too deep or refers to itself.
    """
    try:
        loader = _Loader(text)
        loader.name = Path(source).name
        return loader.get_single_data()
    except Exception as error:  # PyYAML lets others through: chr() of a wrong escape
        raise ValueError(f"{source}: {str(error)[:_MESSAGE]}") from error


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader with limits; it refuses a key given twice and reads 1e-3 as YAML 1.2 does."""

    def __init__(self, stream: str | bytes) -> None:
        super().__init__(stream)
        self._nodes = self._depth = 0
        self._sizes: dict[int, tuple[int, int]] = {}

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._nodes, self._depth = self._nodes + 1, self._depth + 1
        if self._nodes > NODES or self._depth > DEPTH:
            _refuse_size(self._depth > DEPTH, self.peek_event().start_mark)
        alias = self.check_event(yaml.AliasEvent)
        node: Any = super().compose_node(parent, index)
        if alias and id(node) not in self._sizes:
            raise yaml.MarkedYAMLError(problem="it refers to itself", problem_mark=node.start_mark)
        if not alias:  # number of values and height of a node, each alias counted with all that it stands for
            children = [] if isinstance(node, yaml.ScalarNode) else node.value
            if isinstance(node, yaml.MappingNode):
                children = [each for pair in children for each in pair]
            inner = [self._sizes[id(child)] for child in children]
            self._sizes[id(node)] = 1 + sum(n for n, _ in inner), 1 + max((h for _, h in inner), default=0)
        size, height = self._sizes[id(node)]
        if size > NODES or self._depth + height - 1 > DEPTH:
            _refuse_size(size <= NODES, node.start_mark)
        self._depth -= 1
        return node

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        if node.tag in _NUMBERS and len(node.value) > DIGITS:
            problem = f"a number has at most {DIGITS} characters"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)
        try:
            return super().construct_object(node, deep)
        except yaml.YAMLError:
            raise
        except Exception as error:  # a wrong value of a tag: ValueError, IndexError, KeyError and others
            problem = f"{brief(node.value, 40)}: {brief(error)}"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark) from error

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                continue
            if key.value in seen:
                raise yaml.MarkedYAMLError(
                    problem=f"duplicate key {brief(repr(key.value))}", problem_mark=key.start_mark
                )
            seen.add(key.value)
        return super().construct_mapping(node, deep)


def _refuse_size(deep: bool, mark: Any) -> None:
    problem = f"nested deeper than {DEPTH} levels" if deep else f"more than {NODES} values, aliases included"
    raise yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


_Loader.add_implicit_resolver("tag:yaml.org,2002:float", _YAML_1_2_FLOAT, list("-+.0123456789"))
