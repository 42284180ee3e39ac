"""The benchmark measures what it says; how fast things are is not tested."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pybullet
import pytest

from lab.benchmarking import batch, measure
from lab.benchmarking.bare import BareLoop
from lab.benchmarking.layers import Layers
from lab.benchmarking.timing import compare
from slipgym.config import load

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def bare():
    simulation = BareLoop(load())
    yield simulation
    simulation.close()


@pytest.mark.slow
def test_the_bare_loop_simulates_the_environments_scene(bare):
    bare.run(1000)
    assert bare.held()
    env = measure.Player("slipgym/LinearSlip-v0").env
    env.reset(seed=0)
    ours, theirs = bare._client, env.simulation.world.client
    for client in (ours, theirs):
        assert pybullet.getNumBodies(physicsClientId=client) == 2
    parameters = [pybullet.getPhysicsEngineParameters(physicsClientId=client) for client in (ours, theirs)]
    assert parameters[0] == parameters[1]
    dynamics = [
        pybullet.getDynamicsInfo(world, -1, physicsClientId=client)[:3]
        for world, client in ((bare._body, ours), (env.simulation.world.body, theirs))
    ]
    assert dynamics[0] == dynamics[1]
    counts = [len(pybullet.getContactPoints(physicsClientId=client)) for client in (ours, theirs)]
    assert counts == [8, 8]
    env.close()


def test_the_bare_loop_replays_an_environments_motion(bare):
    player = measure.Player("slipgym/LinearSlip-v0")
    played = Layers(player.env, measure.ACTIONS, steps=30)
    played.record()
    bare.load(played.start)
    bare.replay(played.loads)
    reading, slip = player.env.simulation.world.reading, player.env.simulation.plant.world["slip"][0, 1]
    pose = pybullet.getBasePositionAndOrientation(bare._body, bare._client)
    assert abs(slip) > 1e-4
    assert pose == reading[0]
    player.env.close()


def test_layers_play_the_same_motion():
    player = measure.Player("slipgym/LinearSlip-v0")
    played, ends = Layers(player.env, measure.ACTIONS, steps=30), []
    for prepare in (played.world, played.simulation, played.environment):
        prepare()()
        ends.append(player.env.simulation.world.reading[0])
    assert ends[0] == ends[1] == ends[2]
    player.env.close()


def test_the_player_lets_the_box_slip_and_goes_on():
    player = measure.Player("slipgym/LinearSlip-v0")
    slips = 0
    for _ in range(40):
        seconds, steps = player.block()
        assert seconds > 0.0
        assert 0 < steps <= 4 * measure.BLOCK
        slips += abs(player.env.simulation.plant.world["slip"][0, 1]) > 1e-3
    assert slips > 5
    player.env.close()


def test_every_part_of_a_step_is_found_and_put_back():
    player = measure.Player("slipgym/Hold-v0")
    env, simulation = player.env, player.env.simulation
    figures = measure.breakdown(player, 4)
    for owner in (env, simulation, simulation.world, simulation.world.rows):
        left = [name for name, value in vars(owner).items() if getattr(value, "__name__", "") == "timed"]
        assert left == []
    assert all(figure.value > 0.0 for figure in figures)
    player.env.close()


@pytest.mark.parametrize(
    "env_id", ["slipgym/LinearSlip-v0", pytest.param("slipgym/Hold-v0", marks=pytest.mark.slow)]
)
@pytest.mark.slow  # it compiles every option of the physics
def test_the_script_runs(tmp_path, env_id):
    path = tmp_path / "figures.json"
    command = [
        sys.executable,
        "-m",
        "slipgym",
        "benchmark-parts",
        "all",
        "--env",
        env_id,
        "--pairs",
        "2",
        "--json",
        path,
    ]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    names = [figure["name"] for figure in json.loads(path.read_text())["figures"]]
    assert len(names) == len(set(names)) >= 15
    assert all(name in done.stdout for name in names)


def test_a_third_of_the_headlines_rows_slips_and_none_of_a_firm_hold():
    slipping = {}
    for name, forces in batch.WORKLOADS.items():
        player = batch.VectorPlayer("slipgym/LinearSlip-v0", 64, forces)
        player.block(64 * 200)
        slipping[name] = batch.slipping(player, 60)
        player.env.close()
    assert 0.25 < slipping["about the slip limit"] < 0.42
    assert slipping["all forces, mostly a firm hold"] < 0.01


def test_compare_takes_medians_of_ratios_of_neighbours():
    first = iter([(1.0, 10), (2.0, 10), (9.0, 10)])
    second = iter([(3.0, 10), (8.0, 10), (9.0, 10)])
    result = compare(lambda: next(first), lambda: next(second), 3)
    assert result[:2] == pytest.approx((0.2, 0.8))
    assert result.quartiles == pytest.approx((2.0, 3.0, 3.5))
