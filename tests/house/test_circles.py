"""Files of a package import each other one way, imports in functions and for type checkers included."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("estimator", "slipgym", "policies", "lab")


def modules(folder: Path) -> dict[str, Path]:
    """Dotted name -> file, of a package."""
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(source: str, known: dict[str, Path]) -> Iterator[str]:
    """Modules that a source imports anywhere, by a statement or by a call with a literal name."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in known else node.module
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "__import__"):
                yield str(node.args[0].value)


def circles(folder: Path) -> list[list[str]]:
    """Groups of modules that import each other, directly or by way of others (Tarjan's algorithm)."""
    known = modules(folder)
    arrows = {}
    for name, path in known.items():
        others = set(imported(path.read_text(), known)) - {name}
        arrows[name] = sorted(others & set(known))
    order: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(name: str) -> None:
        order[name] = lowest[name] = len(order)
        stack.append(name)
        for other in arrows[name]:
            if other not in order:
                visit(other)
                lowest[name] = min(lowest[name], lowest[other])
            elif other in stack:
                lowest[name] = min(lowest[name], order[other])
        if lowest[name] == order[name]:
            at = stack.index(name)
            group = sorted(stack[at:])
            del stack[at:]
            if len(group) > 1:
                found.append(group)

    for name in arrows:
        if name not in order:
            visit(name)
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_files_import_one_way(package):
    assert circles(ROOT / package) == []


@pytest.mark.parametrize(
    "back",
    [
        "import house.a",
        "from house import a",
        "from house.a import something",
        "def f():\n    from house.a import something",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from house.a import Something",
        "import importlib\nimportlib.import_module('house.a')",
    ],
)
def test_a_planted_circle_is_found(back, tmp_path):
    house = tmp_path / "house"
    house.mkdir()
    (house / "__init__.py").write_text("")
    (house / "a.py").write_text("from house.b import one")
    (house / "b.py").write_text("from house import c\nimport numpy")
    (house / "c.py").write_text(back)
    assert circles(house) == [["house.a", "house.b", "house.c"]]
    (house / "c.py").write_text("import os")
    assert circles(house) == []
