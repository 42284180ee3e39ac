"""The learned policies that come with slipgym: whole, small, and as good as they are said to be."""

import csv
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.learned import LearnedPolicy, pretrained
from policies.training import files
from policies.training.curve import Row, best
from slipgym.tasks import TASKS

SHIPPED = pretrained.folders()
WITHOUT = {"fragile_hold", "carry", "explore", "pivot_to"}
"""Tasks for which none is trained yet."""
PAGES = Path(__file__).parents[3] / "docs" / "learned"


def point(row):
    numbers = {name: float(row[name]) for name in ("success", "drops", "reward", "length")}
    return Row(int(row["steps"]), **numbers)


def told(name):
    """Configuration and friction source of a shipped policy."""
    return (name, "true") if name.endswith("_scratch") else tuple(name.rsplit("_", 1))


def made(name, **others):
    """An environment for a policy, as it was trained."""
    where = LearnedPolicy(SHIPPED[name]).description.environment
    return gym.make(f"slipgym:{where.id}", **{**where.arguments, "engine": "planar", **others})


def test_there_is_one_for_every_friction_source():
    sources = ("estimated", "true", "none")
    names = {name for name in SHIPPED if not name.endswith("_scratch")}
    keys = {name.rsplit("_", 1)[0] for name in names}
    assert keys == {task.key for task in TASKS.values()} - WITHOUT
    assert names == {f"{key}_{source}" for key in keys for source in sources}


@pytest.mark.parametrize("name", [name for name in SHIPPED if name.endswith(("_estimated", "_scratch"))])
@pytest.mark.quick_cases("hold_estimated", "carry_scratch")
def test_it_solves_most_episodes(name):
    policy, n = policies.load(name), 24
    where = policy.description.environment
    arguments = {**where.arguments, "autoreset_mode": "Disabled"}
    envs = gym.make_vec(f"slipgym:{where.id}", n, "vector_entry_point", **arguments)
    observations, _ = envs.reset(seed=12345)
    running, solved, state = np.ones(n, bool), np.zeros(n, bool), None
    while running.any():
        actions, state = policy.predict(observations, state)
        observations, _, terminated, truncated, infos = envs.step(actions)
        ended = running & (terminated | truncated)
        if ended.any():
            solved |= ended & infos["is_success"]
            running &= ~ended
            observations, _ = envs.reset(options={"reset_mask": ended})
    envs.close()
    assert solved.mean() >= 0.75


@pytest.mark.parametrize("name", SHIPPED)
def test_it_fits_its_environment_by_either_way_to_get_it(name):
    assert sum(file.stat().st_size for file in SHIPPED[name].iterdir()) < 100_000
    one, other = policies.make(name), policies.load(name)
    assert told(name)[1] == one.description.environment.arguments["friction_source"]
    with made(name) as env:
        one.check(env)
        observation, _ = env.reset(seed=0)
        np.testing.assert_array_equal(one.predict(observation)[0], other.predict(observation)[0])
        assert env.action_space.contains(one.predict(observation)[0])


@pytest.mark.parametrize("name", SHIPPED)
def test_its_seed_is_among_those_whose_curves_are_shown(name):
    origin = LearnedPolicy(SHIPPED[name]).description.origin
    key, source = told(name)
    with (PAGES / f"{key}.csv").open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["source"] == source]
    assert len({row["seed"] for row in rows}) >= (1 if name.endswith("_scratch") else 3)
    seed, steps = str(origin.seeds[0]), str(origin.steps)
    episodes = files.load(key).evaluation.episodes
    curves = {k: [point(row) for row in rows if row["seed"] == k] for k in sorted({r["seed"] for r in rows})}
    ends = [best(points, episodes) for points in curves.values()]
    assert best(ends, episodes) in curves[seed]
    assert str(best(ends, episodes).steps) == steps
    command = f"python scripts/train.py {key} --friction-source {source} --seeds {seed}"
    assert origin.command == command


def test_only_those_of_rotational_slip_solve_more_than_the_controllers_they_began_as():
    """As docs/learned.md says: the best checkpoint of each source against its controller, at 0 steps."""
    episodes, moved = 512, set()
    for key in {task.key for task in TASKS.values()} - WITHOUT:
        with (PAGES / f"{key}.csv").open(encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        for source in ("estimated", "true", "none"):
            own = [row for row in rows if row["source"] == source]
            first = np.mean([float(row["success"]) for row in own if row["steps"] == "0"])
            largest = max(float(row["success"]) for row in own)
            if largest - first > 2.0 * np.sqrt(first * (1.0 - first) / episodes):
                moved.add(f"{key}_{source}")
    assert moved == {f"rotational_slip_{source}" for source in ("estimated", "true", "none")}
