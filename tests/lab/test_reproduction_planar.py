"""The paper's planar motion: the task, its controller, and what the full run must show."""

import math

import numpy as np
import pandas as pd
import pytest

from lab.reproduction import mechanism, reproduce_planar
from lab.reproduction.hanging import TASK
from lab.reproduction.planar import hinge_force, record_planar
from lab.reproduction.rerun import Variant, rows
from slipgym.envs.bullet_simulation import BulletSimulation
from slipgym.tasks import configure

SCENARIO = {"material": "wood", "trial": 0, "seed": 5}


@pytest.fixture(scope="module")
def record():
    return record_planar(SCENARIO, "ellipsoid")


def test_the_wrist_turns_by_the_angle_and_a_firmly_held_object_with_it():
    simulation = BulletSimulation(*configure(TASK, sensors="ideal"), TASK, "rls")
    rng = np.random.default_rng(0)
    simulation.reset(TASK.options.parse({"turn": 0.3, "duration": 1.0, "initial_force": 20.0}), "wood", rng)
    for _ in range(int(simulation.episode["steps"][0])):
        simulation.sample(20.0)
    assert simulation.time == pytest.approx(2.0)
    assert simulation.plant.world["wrist"][0] == pytest.approx([0.0, 0.0, 0.3], abs=1e-6)
    assert simulation.plant.world["angle"][0] == pytest.approx(0.3, abs=1e-4)
    simulation.world.close()


def test_the_controller_is_the_papers():
    wrenches = np.array([[3.0, 4.0, 9.0, 0.1], [0.0, 3.0, 9.0, 0.1]])
    twists = np.array([[0.03, 0.0, 1.0], [0.03, 0.08, 1.0]])
    assert hinge_force(wrenches, twists, 0.5) == pytest.approx(1.4 * 4.0 / 0.5 + 100.0 * 0.05)
    assert hinge_force(0.0 * wrenches, 0.0 * twists, 0.5) == 0.6


def test_the_object_slides_and_turns_and_is_not_lost(record):
    assert not record.dropped
    assert abs(record.slip[-1, 2]) > math.radians(15.0)
    assert np.hypot(*record.slip[-1, :2]) > 0.002
    sliding = mechanism.truly_sliding(record)
    scaled = record.slip_twist[sliding] * (1.0, 1.0, record.truth[2])
    gamma_t = np.hypot(scaled[:, 0], scaled[:, 1]) / np.linalg.norm(scaled, axis=1)
    assert 0.4 < np.median(gamma_t) < 0.85  # both equations of the estimator have something to say


def test_the_same_seed_gives_the_same_record(record):
    again = record_planar(SCENARIO, "ellipsoid")
    assert again.keys == record.keys
    np.testing.assert_array_equal(again.wrenches, record.wrenches)
    assert record_planar({**SCENARIO, "seed": 6}, "ellipsoid").keys["mass"] != record.keys["mass"]


def test_on_the_ellipsoid_mu_c_and_r_are_both_found(record):
    found = {row["quantity"]: row for row in rows(record, Variant("joint", "joint"))}
    # noise of 0.04 N in 3 N and of 5e-4 in 1e-2 N m, averaged over some fifty samples: below 1 %
    assert found["mu_c"]["mean"] == pytest.approx(found["mu_c"]["true"], rel=0.03)
    assert found["r"]["mean"] == pytest.approx(found["r"]["true"], rel=0.03)


def test_the_grip_rises_too_slowly_for_the_heuristic(record):
    halting, plain = (
        {row["quantity"]: row["mean"] for row in rows(record, Variant("", "rls", {"heuristic": on}))}
        for on in (True, False)
    )
    assert halting["mu_c"] == pytest.approx(plain["mu_c"], rel=0.05)
    assert np.median(mechanism.rises(record)) < 150.0


@pytest.mark.slow
def test_a_run_does_not_depend_on_the_number_of_processes(tmp_path, monkeypatch):
    monkeypatch.setattr("lab.reproduction.planar.TABLES", {"planar": ["plastic"]})
    one, two = (
        reproduce_planar(tmp_path / str(jobs), trials=2, jobs=jobs, contact="ellipsoid", progress=False)
        for jobs in (1, 2)
    )
    for name in ("trials.csv", "table.csv", "samples.csv", "table.md"):
        assert (one / name).read_bytes() == (two / name).read_bytes()
    assert {"trial.png", "slip.png", "table.png"} <= {path.name for path in one.iterdir()}


@pytest.fixture(scope="module")
def full(tmp_path_factory):
    return pd.read_csv(
        reproduce_planar(tmp_path_factory.mktemp("runs"), jobs=2, progress=False) / "table.csv"
    )


@pytest.mark.slow
def test_the_heuristic_hardly_changes_the_planar_table(full):
    mu_c = full[full["quantity"] == "mu_c"].pivot(index="material", columns="estimator", values="mean")
    assert len(mu_c) == 4
    assert np.all(np.abs(mu_c["rls, heuristic"] / mu_c["rls, no heuristic"] - 1.0) < 0.05)
    r = full[(full["quantity"] == "r") & (full["estimator"] == "rls, heuristic")]
    assert r["n"].min() == 10  # learnt in every trial


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["mu_c", "r"])
def test_the_discs_own_limit_surface_takes_the_ellipsoids_bias_away(full, quantity):
    """The ellipsoid's fixed point on a disc is off by -9 and +5 % at gamma_t 0.7."""
    error = full[full["quantity"] == quantity].pivot(index="material", columns="estimator", values="error")
    biased = {"mu_c": (-0.11, -0.07), "r": (0.03, 0.09)}[quantity]
    assert error["joint"].between(*biased).all()
    assert np.all(np.abs(error["disc"]) < 0.03)
