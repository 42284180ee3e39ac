"""A command that loads an estimator says why it takes so long where it has to be compiled."""

from contextlib import contextmanager

from typer.testing import CliRunner

from policies.commands.front import application
from slipgym import loading


def test_the_estimator_is_loaded_with_patience(tmp_path, monkeypatch):
    said = []

    @contextmanager
    def patience(what):
        said.append(what)
        yield

    monkeypatch.setattr(loading, "patience", patience)
    words = ["examples/linear_slip_wood.csv.gz", "--estimator", "rls", "--output", str(tmp_path)]
    done = CliRunner().invoke(application("estimate"), words)
    assert done.exit_code == 0, done.output
    assert said == ["the estimator rls"]
