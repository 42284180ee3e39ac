"""`slipgym train` trains a policy for the task of docs/adding_a_task.md."""

import pytest
from typer.testing import CliRunner

pytest.importorskip("stable_baselines3")
import policies
from policies.commands.train import app
from policies.evaluation import one_policy
from policies.training import files, vector
from slipgym.tasks import TASKS

CONFIGURATION = """
task: slide_to_line:TASK
budget: 256
num_envs: 2
environment: {randomization: none, frame_skip: 4, config: {tasks: {slide_to_line: {duration: 0.2}}}}
evaluation: {every: 128, episodes: 2}
checkpoints: {every: 128}
ppo: {n_steps: 32, batch_size: 32, n_epochs: 1}
"""


def command(*words):
    done = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return done.stdout


def test_a_run_is_trained_resumed_evaluated_and_its_policy_loaded(own_task, tmp_path, monkeypatch):
    (tmp_path / "line.yaml").write_text(CONFIGURATION)
    command(tmp_path / "line.yaml", "--output", tmp_path / "runs")
    (run,) = (tmp_path / "runs").glob("slide_to_line__ppo__*/estimated__0")
    curve = (run / "curve.csv").read_text()
    for path in (*run.glob("policy/*"), run / "result.json", run / "checkpoints/000000000256.checkpoint"):
        path.unlink()
    (run / "policy").rmdir()
    assert "at step 256" in command("--resume", run)  # on from step 128
    assert (run / "curve.csv").read_text() == curve
    policy = policies.load(run / "policy")
    assert policy.description.environment.id == "my/SlideToLine-v0"
    assert "line" in policy.names
    (outcome,) = one_policy.episodes(run / "policy", 1, task="slide_to_line:TASK")
    assert outcome.time == pytest.approx(0.2)
    with monkeypatch.context() as without:
        without.delitem(TASKS, "SlideToLine")  # as in a process that has not imported the module
        with pytest.raises(ValueError, match=r"unknown task 'my/SlideToLine-v0'.*--task module:attribute"):
            policies.load(run / "policy")


def test_environments_in_other_processes_import_its_module(own_task):
    assert vector._id("slide_to_line:TASK") == "slide_to_line:my/SlideToLine-v0"
    assert vector._id("hold") == "slipgym:slipgym/Hold-v0"


def test_the_name_alone_is_refused(own_task, tmp_path):
    (tmp_path / "line.yaml").write_text("task: slide_to_line\nbudget: 10\n")
    with pytest.raises(ValueError, match="name 'slide_to_line', a task of your own, as module:attribute"):
        files.load(tmp_path / "line.yaml")
