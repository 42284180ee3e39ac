"""The task of docs/adding_a_task.md is an environment like those of slipgym."""

import dataclasses
import importlib
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pandas as pd
import pytest
from gymnasium.utils.env_checker import check_env

import slipgym
from lab.montage import take_screenshot
from policies.task_names import own_policy
from slipgym.config.task import InitialForce, TaskConfig
from slipgym.envs import HoldEnv
from slipgym.registration import ENVIRONMENTS, TASK_MODULES
from slipgym.tasks import TASKS, Term, configure, find
from slipgym.tasks.terms import TIME_LEFT, drop

ROOT = Path(__file__).parents[2]
ID = "my/SlideToLine-v0"


class WrongDefault(TaskConfig):
    """Settings whose default is not allowed."""

    initial_force: InitialForce = -1.0


def test_gymnasiums_checker(own_task):
    check_env(gym.make(ID).unwrapped, skip_render_check=True)


def test_an_episode_with_every_kind_of_argument(own_task):
    env = gym.make(
        ID,
        action_mode="grip_force_wrist",
        observation_mode="dict",
        history=2,
        randomization={"tasks": {"slide_to_line": {"mass_scale": {"uniform": [2.0, 3.0]}}}},
        contact="distributed",
        frame_skip=2,
        config={"contact": {"cells": 5}, "tasks": {"slide_to_line": {"line": [0.02, 0.02], "duration": 0.5}}},
    )
    _, info = env.reset(seed=0)
    assert 0.4 <= info["drawn"]["mass"] <= 0.6
    steps, over = 0, False
    while not over:
        _, reward, terminated, truncated, info = env.step(np.float32([1.0, 0.0, 0.0, 0.0]))
        steps, over = steps + 1, terminated or truncated
    assert (steps, terminated, info["dropped"]) == (30, False, False)
    assert info["reference"][0] == 0.02
    assert sum(info["reward_terms"].values()) == pytest.approx(reward)
    assert list(info["reward_terms"]) == ["near", "effort", "solved", "drop"]


def test_the_line_is_drawn_or_given(own_task):
    env = gym.make(ID).unwrapped
    lines = [env.reset(seed=seed)[1]["reference"][0] for seed in range(20)]
    assert 0.01 <= min(lines) < 0.015 < 0.025 < max(lines) <= 0.03
    given, drawn = (env.reset(seed=3, options=options)[1] for options in ({"line": 0.05}, {}))
    assert given["reference"][0] == 0.05
    np.testing.assert_array_equal(given["true"], drawn["true"])


@pytest.mark.parametrize(
    ("config", "said"),
    [
        ({"lime": 1.0}, "tasks.slide_to_line.lime: unknown key 'lime'; did you mean 'line'"),
        ({"tolerance": -1.0}, "tasks.slide_to_line.tolerance = -1.0: must be a finite number > 0 (Largest"),
        ({"reward": {"nearr": 1.0}}, "did you mean 'near'? valid: drop, effort, near, solved"),
        ({"initial_force": 30.0}, "tasks.slide_to_line.initial_force must lie within"),
    ],
)
def test_its_settings_are_checked(own_task, config, said):
    with pytest.raises(ValueError, match=re.escape(said)):
        gym.make(ID, config={"tasks": {"slide_to_line": config}})


def test_its_options_are_checked(own_task):
    with pytest.raises(ValueError, match="unknown option 'lime'; did you mean 'line'"):
        gym.make(ID).reset(seed=0, options={"lime": 0.02})


def test_its_page(own_task):
    text = own_task.SlideToLineEnv.__doc__
    assert text.startswith("Let the object slide down to a line")
    assert "| 18 | `line`: distance of the line | 0 | 1 | m |" in text
    assert "| `near` | dense | 1 | exp(-abs(e) / 10 mm)" in text
    assert "## Starting State" not in text  # it says nothing of it
    wrong = dataclasses.replace(own_task.TASK, page="Summary.\n\n## Rewads\n\nNone.\n")
    with pytest.raises(ValueError, match="unknown section 'Rewads'; valid: Description, Action Space"):
        slipgym.register_task(wrong)


def test_into_another_process(own_task, own_task_folder):
    env = gym.make(ID).unwrapped
    env.reset(seed=1)
    env.step([-0.9])
    code = "import pickle, sys; print(repr(pickle.load(sys.stdin.buffer).step([-0.9])[1]))"
    paths = os.pathsep.join([str(own_task_folder), str(ROOT)])
    done = subprocess.run(
        [sys.executable, "-c", code],
        input=pickle.dumps(env),
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        check=True,
    )
    assert done.stdout.decode().split()[-1] == repr(env.step([-0.9])[1])


def test_the_settings_go_when_the_task_goes(own_task):
    task = own_task.TASK
    held = gym.make("slipgym/Hold-v0").unwrapped.get_state()
    assert "slide_to_line" not in held.made_of["config"]["tasks"]
    overrides = {"tasks": {"slide_to_line": {"duration": 1.0}}}
    assert configure(task, overrides)[1].duration == 1.0
    configure(TASKS["Hold"], overrides)
    before = TASKS.pop("SlideToLine")
    with pytest.raises(ValueError, match="unknown key 'slide_to_line'"):
        configure(TASKS["Hold"], overrides)
    with pytest.raises(ValueError, match="'slide_to_line:TASK' is no task that"):
        find("slide_to_line:TASK")
    TASKS["SlideToLine"] = before
    assert find("slide_to_line:TASK") is find("SlideToLine") is find("slide_to_line") is task


def test_the_picture_shows_its_motion(own_task):
    assert own_policy("SlideToLine") == "constant_force"
    assert take_screenshot(ID, "wood").shape == (480, 720, 3)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"id": "slipgym/Hold-v0"}, "id = 'slipgym/Hold-v0' is one of slipgym's own"),
        ({"id": "my/Hold-v0"}, "name = 'Hold' of my/Hold-v0 is taken by slipgym/Hold-v0"),
        ({"id": "my/Line-v0", "key": "hold"}, "key = 'hold' of my/Line-v0 is taken by slipgym/Hold-v0"),
        ({"id": "my/A Line"}, "id = 'my/A Line'"),
        ({"key": "slide-to-line"}, "key = 'slide-to-line' of my/SlideToLine-v0 must be a word"),
        (
            {"terms": tuple(Term(f"near_{k}", 1.0, "", lambda e, w, f: 0.0) for k in range(13))},
            "has 13 reward terms; at most 12",
        ),
        ({"terms": 2 * (drop,)}, "has two reward terms of the name 'drop'"),
        ({"columns": 2 * (TIME_LEFT,)}, "has two columns of the name 'time_left'"),
        ({"settings": WrongDefault}, "tasks.slide_to_line.initial_force = -1.0: must be a finite number > 0"),
    ],
)
def test_what_is_refused_changes_nothing(own_task, changes, said):
    before = dict(TASKS)
    with pytest.raises(ValueError, match=re.escape(said)):
        slipgym.register_task(dataclasses.replace(own_task.TASK, **changes))
    assert before == TASKS


def test_registering_again_replaces(own_task):
    class Longer(own_task.Settings):
        """Another default."""

        duration: float = 7.0

    own_task.SlideToLineEnv = slipgym.register_task(dataclasses.replace(own_task.TASK, settings=Longer))
    assert gym.make(ID).unwrapped.settings.duration == 7.0


@pytest.mark.slow
def test_evaluation_in_processes_of_their_own(own_task_folder, tmp_path):
    page = (ROOT / "docs" / "adding_a_task.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    (tmp_path / "line.yaml").write_text(text + "config: {tasks: {slide_to_line: {duration: 0.5}}}\n")
    paths = os.pathsep.join([str(own_task_folder), str(ROOT)])
    command = [sys.executable, str(ROOT / "scripts" / "evaluate.py"), "line.yaml", "--jobs", "2"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    (run,) = (tmp_path / "runs").iterdir()
    pictures = {path.name for path in run.glob("*.png")}
    assert pictures == {"tracking_constant_force.png", "errors_constant_force.png"}
    trials = pd.read_csv(run / "trials.csv")
    slid = trials["final_error_mm"]
    assert trials["tolerance_mm"].tolist() == [2.0, 2.0]
    assert ((slid < 0.0) & (slid.abs() == trials["final_error_abs_mm"])).all()
    assert "final error, signed [mm]" in done.stdout


def test_the_rows_name_the_tasks():
    assert set(ENVIRONMENTS) == set(TASK_MODULES)
    for env_id, module in TASK_MODULES.items():
        task = importlib.import_module(module).TASK
        assert task.id == env_id
        assert TASKS[task.name] is find(task.name) is task
        assert ENVIRONMENTS[env_id] == f"slipgym.envs:{task.name}Env"
    assert HoldEnv.__name__ == "HoldEnv"
    with pytest.raises(ImportError):
        from slipgym.envs import HoldUpEnv  # noqa: F401
