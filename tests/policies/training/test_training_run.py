import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

pytest.importorskip("stable_baselines3")
import policies
from policies import parallel
from policies.commands.train import app
from policies.training import (
    checkpoints,
    export,
    files,
    folder,
    run,
    run_set,
    seeds,
    sweep,
    vector,
)
from policies.training import model as learners
from policies.training.callback import evaluate
from policies.training.curve import Row

ROOT = Path(__file__).resolve().parents[3]


def test_a_run_leaves_everything_behind(small, tmp_path):
    path = tmp_path / "run"
    folder.begin(path, small(budget=64), 0)
    result = run.train(path, progress=False)
    for name in ("run.yaml", "versions.json", "curve.csv", "curve.png", "result.json"):
        assert (path / name).stat().st_size > 0, name
    assert {file.name for file in (path / "checkpoints").iterdir()} == {
        *("000000000032.checkpoint", "000000000064.checkpoint", "best.checkpoint")
    }
    assert len(list((path / "tensorboard").iterdir())) == 1
    assert result["ended"] == "budget"
    assert result == json.loads((path / "result.json").read_text()) == run.train(path, progress=False)
    assert result["best"]["reward"] == max(row.reward for row in folder.read_curve(path))


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_the_policy_of_a_run_acts_as_its_learner(small, tmp_path, engine):
    config, path = small(engine=engine, budget=64), tmp_path / "run"
    folder.begin(path, config, 0)
    run.train(path, progress=False)
    policy = policies.load(path / export.POLICY)
    envs = learners.normalised(config, vector.make(config, 0), training=False)
    model = learners.make(config, envs, 0)
    best = checkpoints.read(checkpoints.best(path))["learner"]
    learners.set_parameters(model, best)
    learners.set_normalisation(envs, best["normalisation"])
    seen = envs.venv.reset()
    expected, _ = model.predict(envs.normalize_obs(seen), deterministic=True)
    np.testing.assert_allclose(policy.predict(seen)[0], expected, atol=1e-6)
    envs.close()


def test_a_policy_may_read_the_deviations_of_the_estimates(small, tmp_path):
    environment = {**small().environment.model_dump(), "observation_mode": "deviations"}
    folder.begin(tmp_path / "run", small(environment=environment, budget=64), 0)
    run.train(tmp_path / "run", progress=False)
    described = json.loads((tmp_path / "run" / export.POLICY / "policy.json").read_text())
    assert "sd_mu_c" in [column["name"] for column in described["environment"]["observation"]]


def test_the_environments_are_seeded_apart(small):
    config = small()
    envs, same = vector.make(config, 5), vector.make(config, 5, 3)
    first, second = envs.reset(), same.reset()
    np.testing.assert_array_equal(first, second[:2])
    assert not np.array_equal(first[0], first[1])
    envs.close(), same.close()


def test_evaluation_disturbs_nothing_and_repeats_itself(small):
    config = small(evaluation={"every": 32, "episodes": 3})
    envs = learners.normalised(config, vector.make(config, 0))
    held_out = vector.make(config, seeds.held_out(0), 2)
    model = learners.make(config, envs, 0)
    envs.reset()
    before = learners.normalisation(envs)
    rows = [evaluate(config, model, held_out) for _ in range(2)]
    after = learners.normalisation(envs)
    assert rows[0] == rows[1]
    assert rows[0].length == pytest.approx(12.0)
    np.testing.assert_array_equal(before["observations"]["mean"], after["observations"]["mean"])
    np.testing.assert_array_equal(before["observations"]["var"], after["observations"]["var"])
    envs.close(), held_out.close()


def test_a_run_stops_when_it_succeeds_twice(small, tmp_path, monkeypatch):
    shares = iter([1.0, 0.0, 1.0, 1.0, 1.0])
    monkeypatch.setattr(
        "policies.training.callback.evaluate",
        lambda config, model, envs: Row(model.num_timesteps, next(shares), 0.0, 0.0, 1.0),
    )
    path = tmp_path / "run"
    folder.begin(path, small(budget=960, stop={"success": 0.9, "evaluations": 2}), 0)
    with pytest.warns(UserWarning, match="before any learning"):
        result = run.train(path, progress=False)
    assert (result["ended"], result["steps"]) == ("success", 96)
    assert [row.success for row in folder.read_curve(path)] == [1.0, 0.0, 1.0, 1.0]


def test_a_stopping_rule_that_is_met_before_learning_warns(small, tmp_path, monkeypatch):
    monkeypatch.setattr(
        "policies.training.callback.evaluate",
        lambda config, model, envs: Row(model.num_timesteps, 0.95, 0.0, 0.0, 1.0),
    )
    path = run_set.begin(small(stop={"success": 0.9, "evaluations": 1}), [0], [], tmp_path)
    with pytest.warns(UserWarning, match=r"solves 95% .*stop\.success is 0\.9"):
        text = run_set.train_all(path, progress=False)
    assert "ended by success at step 0" in text
    assert text.endswith("nothing was learned")


@pytest.mark.parametrize(
    ("changes", "kind"),
    [
        ({"algorithm": "privileged_ppo", "privileged_ppo.start": "given/policy"}, "policy"),
        ({"privileged_ppo.start": "given/policy"}, None),  # of a learner that does not run
        ({}, None),
    ],
)
@pytest.mark.parametrize("steps", [0, 96])
def test_a_run_that_is_best_before_learning_says_what_solves_as_many(small, tmp_path, changes, kind, steps):
    place = tmp_path / "estimated__0"
    folder.begin(place, files.changed(small(), changes), 0)
    best = {"steps": steps, "success": 0.95}
    folder.write_result(place, {"ended": "budget", "steps": 96, "seconds": 1.0, "best": best})
    started = f": the {kind} that it started from solves as many" if kind and not steps else ""
    said = f"solved 95% of the held-out episodes at step {steps}{started}; ended by budget"
    assert said in run_set.train_all(tmp_path, progress=False)


def test_seeds_and_sources_run_side_by_side(small, tmp_path):
    path = run_set.begin(small(budget=32), [0, 1], ["true", "none"], tmp_path)
    text = run_set.train_all(path, jobs=1, progress=False)
    names = {"true__0", "true__1", "none__0", "none__1"}
    assert {one.name for one in path.iterdir()} == {*names, "curves.png"}
    assert all(name in text for name in names)
    configs = {name: folder.order(path / name) for name in names}
    assert {name: config.environment.friction_source for name, (config, _) in configs.items()} == {
        name: name.partition("__")[0] for name in names
    }
    with pytest.raises(ValueError, match="seed = -1"):
        run_set.begin(small(), [0, -1], [], tmp_path / "refused")
    assert not (tmp_path / "refused").exists()


def test_a_sweep_tries_what_is_declared(small, tmp_path):
    config = small(
        budget=32,
        sweep={
            "ppo.gamma": {"low": 0.9, "high": 0.99},
            "ppo.net_arch": {"choices": [[4], [4, 4]]},
            "ppo.n_epochs": {"low": 1, "high": 2},
        },
    )
    path = sweep.begin(config, tmp_path)
    text = sweep.sweep(path, config, 2, progress=False)
    tried = [folder.order(run)[0].ppo for run in sorted(path.glob("trial__*"))]
    assert len(tried) == 2
    assert len({ppo.gamma for ppo in tried}) == 2
    assert all(0.9 <= ppo.gamma <= 0.99 and ppo.net_arch in ((4,), (4, 4)) for ppo in tried)
    assert str(path) in text
    assert (path / "best.yaml").is_file()


def test_the_area_rewards_learning_early(small):
    config = small(budget=96)
    rows = [Row(steps, success, 0.0, 0.0, 1.0) for steps, success in ((0, 0.0), (32, 1.0))]
    assert sweep.area(rows, config) == 0.75
    assert sweep.area([rows[0]] * 3 + [rows[1]], config) == 0.25


def test_ray_that_is_missing_is_asked_for(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'slipgym\[ray\]'"):
        list(parallel.results(divmod, [(7, 3)], ray="local"))


@pytest.mark.slow
def test_ray_does_the_same(tmp_path):
    pytest.importorskip("ray")
    home = {**os.environ, "HOME": str(tmp_path), "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path[1:]])}
    small = ["budget=512", "num_envs=16", "evaluation.episodes=2", "privileged_ppo.n_minibatches=2"]

    def called(where, *words):
        command = [sys.executable, "-m", "slipgym", *words, "--output", str(tmp_path / where)]
        done = subprocess.run(command, env=home, capture_output=True, text=True, check=False)  # HOME: a token
        assert done.returncode == 0, done.stderr

    train = ["train", "linear_slip_scratch", "--seeds", "0", "1", "--set", *small]
    trials = ["evaluate", "hold", "--trials", "1", "--friction-source", "true"]
    for words, kept in ((train, "**/curve.csv"), (trials, "**/trials.parquet")):
        called("ray", *words, "--ray", "local")
        called("here", *words)
        found, wanted = (sorted((tmp_path / where).glob(kept)) for where in ("ray", "here"))
        assert len(found) == len(wanted) > 0
        for one, other in zip(found, wanted, strict=True):
            assert one.read_bytes() == other.read_bytes()


def test_the_command_trains(small, tmp_path, monkeypatch):
    from policies.training.files import text

    (tmp_path / "mine.yaml").write_text(text(small(budget=32)))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    words = ["mine.yaml", "--seeds", "4", "--set", "ppo.gamma=0.9", "num_envs=1"]
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    ((run_folder),) = (tmp_path / "runs").glob("*/estimated__4")
    config, seed = folder.order(run_folder)
    assert (seed, config.ppo.gamma, config.num_envs) == (4, 0.9, 1)
    assert "solved" in done.stdout
    assert f"--resume {run_folder.parent}" in done.stdout


@pytest.mark.parametrize(
    ("algorithm", "more"), [("ppo", {"batch_size": 16}), ("privileged_ppo", {"n_minibatches": 1})]
)
def test_numbers_that_are_not_finite_end_a_run(small, tmp_path, algorithm, more):
    """The step size is far too large; no checkpoint holds what it made."""
    from policies.training.files import text

    config = small(algorithm=algorithm, **{algorithm: {"n_steps": 16, "learning_rate": 1e30, **more}})
    (tmp_path / "mine.yaml").write_text(text(config))
    done = CliRunner().invoke(app, [str(tmp_path / "mine.yaml"), "--output", str(tmp_path / "runs")])
    assert done.exit_code == 1
    assert "error: after 32 steps a parameter of the learner is NaN or beyond 1e+12" in done.stderr
    assert done.stderr.rstrip().endswith("what was trained so far is in the last checkpoint")
    assert [path.stem for path in (tmp_path / "runs").glob("*/*/checkpoints/*")] == ["best"]  # of step 0


def test_a_policy_learned_with_a_file_of_a_randomization(small, tmp_path):
    (tmp_path / "mine.yaml").write_text("noise_scale: {uniform: [0.5, 1.5]}\n")
    environment = {**small().environment.model_dump(), "randomization": str(tmp_path / "mine.yaml")}
    folder.begin(tmp_path / "run", small(environment=environment, budget=32), 0)
    (tmp_path / "mine.yaml").unlink()
    run.train(tmp_path / "run", progress=False)
    policy = policies.load(tmp_path / "run" / "policy")
    assert policy.description.environment.arguments["randomization"] == {
        "noise_scale": {"uniform": [0.5, 1.5]}
    }


def test_a_mistake_on_the_command_line_is_explained(small, tmp_path):
    from policies.training.files import text

    (tmp_path / "mine.yaml").write_text(text(small(budget=32)))
    wrong = CliRunner().invoke(app, [str(tmp_path / "mine.yaml"), "--algorithm", "pppo"])
    assert wrong.exit_code == 2
    assert "'recurrent_ppo'" in wrong.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", files.names())
def test_every_configuration_trains(name, tmp_path):
    short = {"budget": 512, "num_envs": 8, "evaluation.every": 512, "evaluation.episodes": 8}
    sizes = {"ppo.n_steps": 32, "ppo.batch_size": 128, "ppo.n_epochs": 1}
    path = tmp_path / name
    folder.begin(path, files.changed(files.load(name), {**short, **sizes}), 0)
    assert run.train(path, progress=False)["ended"] == "budget"
    policies.load(path / export.POLICY)
