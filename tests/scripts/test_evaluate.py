import pytest

EXPERIMENT = """
name: small
task: LinearSlip
trials: 3
options: {duration: 0.2, settle: 0.0, hold: 0.0}
policies: [{name: constant_force}]
friction: [{source: estimated}]
"""


def test_help_teaches(invoke):
    done = invoke("evaluate", "--help")
    assert done.exit_code == 0, done.stderr
    for word in ("--demo", "--trials", "--jobs", "--friction-source", "--output", "--seed", "Examples"):
        assert word in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "linear_slip"),
        (["demmo"], "did you mean 'demo'"),
        (["demo", "--friction-source", "guess"], "unknown friction"),
        (["nowhere.yaml"], "nowhere.yaml"),
    ],
)
def test_mistakes_are_explained_without_a_traceback(tmp_path, invoke, arguments, message):
    done = invoke("evaluate", *arguments)
    assert done.exit_code == 2
    assert message in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_experiment_of_ones_own_runs_in_any_folder(tmp_path, invoke, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    (tmp_path / "mine.yaml").write_text(EXPERIMENT)
    done = invoke("evaluate", "mine.yaml", "--trials", "1", "--jobs", "1", "--seed", "7")
    assert done.exit_code == 0, done.stderr
    (run,) = (tmp_path / "runs").iterdir()
    assert run.name.startswith("small__7__")
    for name in ("tracking_constant_force.png", "summary.md"):
        assert str(run / name) in done.stdout
    assert "success [%]" in done.stdout
