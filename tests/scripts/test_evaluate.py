import pytest
import yaml

from policies.evaluation import load_experiment

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


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--friction-source", "true"], "with --policy: --set friction_source=true"),
        (["--level", "hard"], "with --policy: --set level=hard"),
        (["--output", "mine"], "--output is for experiments"),
        (["--jobs", "1"], "--jobs is for experiments"),
        (["--ray", "local"], "--ray is for experiments"),
    ],
)
def test_options_of_experiments_are_refused_with_a_policy(invoke, arguments, message):
    done = invoke("evaluate", "--policy", "linear_slip", *arguments)
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"policies": [{"name": "linear_slip", "parameters": {"kpp": 3.0}}]}, "unknown parameter 'kpp'"),
        ({"policies": [{"name": "hold"}]}, "hold, true: observation has 35 columns; Hold has 29"),
        ({"friction": [{"source": "none"}]}, "linear_slip, none: "),
        ({"friction": [{"source": "estimated", "estimator": None}]}, "acts on estimates"),
        ({"options": {"mu_s": 0.1}}, "linear_slip, true: mu_s = 0.1 must be at least mu_c"),
        ({"materials": ["wood", "wood"]}, "materials = ['wood', 'wood']: expected values, each once"),
        ({"vary": {"tolerance": []}}, "vary.tolerance = []: expected values, each once"),
    ],
)
def test_what_cannot_run_is_refused_before_any_trial(tmp_path, invoke, monkeypatch, change, message):
    monkeypatch.chdir(tmp_path)
    same = {"policies": [{"name": "linear_slip"}], "friction": [{"source": "true"}], "engine": "planar"}
    values = {"name": "mine", "task": "linear_slip", "trials": 1, **same, **change}
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")
    done = invoke("evaluate", "mine.yaml", "--jobs", "1")
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())
    assert [path.name for path in tmp_path.iterdir()] == ["mine.yaml"]


def test_an_experiment_keeps_the_content_of_its_files(tmp_path):
    level, ranges = tmp_path / "level.yaml", tmp_path / "ranges.yaml"
    level.write_text("settings: {tolerance: 0.004}\n", encoding="utf-8")
    ranges.write_text("noise_scale: {uniform: [0.5, 1.5]}\n", encoding="utf-8")
    same = {"policies": [{"name": "linear_slip"}], "friction": [{"source": "true"}], "trials": 1}
    values = {
        "name": "mine",
        "task": "linear_slip",
        **same,
        "level": str(level),
        "randomization": str(ranges),
    }
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")
    found = load_experiment(tmp_path / "mine.yaml")
    assert found.level == {"settings": {"tolerance": 0.004}}
    assert found.randomization == {"noise_scale": {"uniform": [0.5, 1.5]}}
    assert found.configured()[1].tolerance == 0.004
