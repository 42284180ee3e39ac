"""Files of the estimator package import each other in one direction."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import estimator

PACKAGE = Path(estimator.__file__).parent


def module(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(source: str, known: set[str]) -> set[str]:
    """Modules that a source imports anywhere, also inside functions and for type checking only."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= inner & known or {node.module}
    return found & known


def graph(sources: dict[str, str]) -> dict[str, set[str]]:
    return {name: imports(source, set(sources)) for name, source in sources.items()}


def test_no_file_imports_itself_through_others():
    sources = {module(path): path.read_text() for path in PACKAGE.rglob("*.py")}
    arrows = graph(sources)
    assert arrows["estimator.disc"] >= {"estimator.joint", "estimator.registry"}
    TopologicalSorter(arrows).prepare()


@pytest.mark.parametrize(
    "back",
    ["import p.a", "from p import a", "from p.a import x", "def f():\n    from p.a import x"],
)
def test_a_circle_is_found(back):
    sources = {"p": "", "p.a": "from p.b import y", "p.b": back}
    with pytest.raises(CycleError):
        TopologicalSorter(graph(sources)).prepare()


def test_files_are_short():
    assert {path.name for path in PACKAGE.rglob("*.py") if len(path.read_text().splitlines()) > 300} == set()
