"""Commands called in this process, which saves the imports of a new one."""

import pytest
from typer.testing import CliRunner

from policies.commands.front import application


@pytest.fixture
def invoke(tmp_path, monkeypatch):
    """Calls a command in an empty folder; an exception that the command does not explain is raised."""
    monkeypatch.chdir(tmp_path)

    def call(name, *arguments):
        app = application(name.replace("_", "-"))
        return CliRunner().invoke(app, [*map(str, arguments)], catch_exceptions=False)

    return call
