"""Commands that load an estimator say why it takes so long where it has to be compiled."""

from contextlib import contextmanager

import pytest
from typer.testing import CliRunner

from policies.commands.front import application
from slipgym import loading


@pytest.mark.parametrize(
    "words",
    [
        ["estimate", "examples/linear_slip_wood.csv.gz", "--estimator", "rls"],
        ["live", "--estimator", "rls", "--port", "0", "--seconds", "0.1"],
    ],
)
def test_the_estimator_is_loaded_with_patience(words, tmp_path, monkeypatch):
    said = []

    @contextmanager
    def patience(what):
        said.append(what)
        yield

    monkeypatch.setattr(loading, "patience", patience)
    output = ["--output", str(tmp_path)] * (words[0] == "estimate")
    done = CliRunner().invoke(application(words[0]), [*words[1:], *output])
    assert done.exit_code == 0, done.output
    assert said == ["the estimator rls"]
