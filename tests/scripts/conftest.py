"""Scripts called in this process, which saves the imports of a new one."""

import importlib.util
from pathlib import Path

import pytest
from typer.testing import CliRunner

ROOT = Path(__file__).resolve().parents[2]


def script(name):
    """A script as a module."""
    spec = importlib.util.spec_from_file_location(f"script_{name}", ROOT / "scripts" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def invoke(tmp_path, monkeypatch):
    """Calls a script in an empty folder; an exception that the script does not explain is raised."""
    monkeypatch.chdir(tmp_path)

    def call(name, *arguments):
        return CliRunner().invoke(script(name).app, [*map(str, arguments)], catch_exceptions=False)

    return call
