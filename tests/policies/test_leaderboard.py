"""The leaderboard: what is fed, how it is scored and ranked."""

import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import estimator
from estimator.estimate import ESTIMATE
from estimator.registry import specification
from policies.leaderboard import run_leaderboard
from policies.leaderboard.imperfect import swinging
from policies.leaderboard.imperfections import IMPERFECTIONS, without
from policies.leaderboard.ranking import ranked, winners
from policies.leaderboard.run import GROUPS, entrants, evaluate
from policies.leaderboard.scenario import FIELDS, Run, Scenario, ends, replay, score
from policies.leaderboard.scenarios import MU_C, QUICK, R, closed_loop, mixed, patch
from slipgym.config import load
from slipgym.synthetic import Record, sense


@pytest.fixture(scope="module")
def record() -> Record:
    return sense(patch(mixed(), cells=11), m=3)


@pytest.fixture(scope="module")
def leap():
    """A closed-loop trial."""
    return closed_loop("wood", ((0.02, 2.0),))[0]


def test_replay_is_the_online_estimator_row_by_row(record):
    batch = replay("rls", record, 1)
    alone = estimator.make("rls")
    for k, t in enumerate(record.t):
        estimate = alone.update(float(t), record.wrenches[2, k], record.twists[2, k])
        assert batch[2, k].item() == tuple(estimate)


def test_replay_tells_the_latency_to_those_who_ask(record):
    told, other = replay("joint", record, 2), replay("joint", record, 0)
    np.testing.assert_array_equal(told, replay("joint", record, 0, velocity_delay=2))
    assert (told["mu_c"] != other["mu_c"]).any()
    np.testing.assert_array_equal(replay("rls", record, 2), replay("rls", record, 0))


def test_replay_starts_each_row_from_its_own_values(record):
    starts = {"r0": np.array([0.005, 0.01, 0.02]), "mu_c0": np.array([0.2, 0.5, 1.0])}
    first = replay("rls", record, 1, starts)[:, 0]
    np.testing.assert_array_equal(first["r"], starts["r0"])
    np.testing.assert_array_equal(first["mu_c"], starts["mu_c0"])


def made_up(m: int = 4, n: int = 60) -> tuple[Run, np.ndarray]:
    """A record with constant truth, slipping from sample 20 on, and estimates that are exact."""
    phase = np.where(np.arange(n) < 20, "stop", "slide")
    truth = {"mu_s": np.full(n, 0.5), "mu_c": np.full(n, 0.4), "r": np.full(n, 0.008)}
    record = Record(np.arange(1, n + 1) / 120, np.zeros((m, n, 4)), np.zeros((m, n, 3)), **truth, phase=phase)
    estimates = np.zeros((m, n), ESTIMATE)
    for field, values in truth.items():
        estimates[field] = values
    return Run(record, {"mu_c": ends(record, "slide"), "r": phase == "slide"}), estimates


def test_score_on_figures_made_by_hand():
    run, estimates = made_up()
    estimates["mu_c"][:, -1] *= [1.1, 1.3, 1.1, 1.3]
    estimates["sd_mu_c"][:, -1] = [0.041, 0.119, 0.0, 0.13]  # errors: 0.04, 0.12, 0.04, 0.12
    estimates["r"][:, :30] *= 2.0  # 10 samples of slip
    found = score(Scenario("", "", (run,)), [estimates])
    assert found["bias_mu_c"] == pytest.approx(20.0)
    assert found["spread_mu_c"] == pytest.approx(10.0)
    assert found["error_mu_c"] == pytest.approx(np.sqrt((10.0**2 + 30.0**2) / 2))
    assert found["calibration_mu_c"] == 0.5
    assert found["time_mu_c"] == 0.0
    assert found["bias_r"] == pytest.approx(25.0)
    assert found["spread_r"] == 0.0
    assert found["error_r"] == pytest.approx(50.0)
    assert found["calibration_r"] == 0.75
    assert found["time_r"] == pytest.approx(10 / 120)
    assert np.isnan(found["error_mu_s"])
    assert np.isnan(found["lock_ups"])


def test_what_is_never_close_takes_for_ever():
    run, estimates = made_up()
    estimates["mu_c"][:, ::20] *= 1.06  # close for 19 samples at a time, not for 24
    assert score(Scenario("", "", (run,)), [estimates])["time_mu_c"] == np.inf


def test_a_lock_up_depends_on_the_start_value():
    run, estimates = made_up()
    scenario = Scenario("", "", (run, run), starts={"r0": np.ones(4)})
    estimates["mu_c"] *= 0.8  # a bias that all share
    assert score(scenario, [estimates, estimates])["lock_ups"] == 0.0
    locked = estimates.copy()
    locked["r"][2, -1] *= 1.06
    locked["mu_c"][2, -1] *= 0.9
    locked["mu_c"][3, -1] *= 1.04
    assert score(scenario, [estimates, locked])["lock_ups"] == pytest.approx(1 / 6)


def test_a_group_counts_as_much_as_another():
    rows = [
        *({"group": "one", "estimator": "a", "error_mu_c": e} for e in (3.0, 4.0, 5.0)),
        *({"group": "one", "estimator": "b", "error_mu_c": e} for e in (8.0, 8.0, 8.0)),
        {"group": "two", "estimator": "a", "error_mu_c": 0.01},
        {"group": "two", "estimator": "b", "error_mu_c": 2.0},
    ]
    rest = {"error_r": 10.0, "error_mu_s": 1.0, "time_mu_c": 1.0, "lock_ups": np.nan}
    rest |= {f"calibration_{field}": 0.5 for field in FIELDS}
    table = pd.DataFrame([{**row, **rest} for row in rows])
    ranking = ranked(table)
    assert ranking["estimator"].tolist() == ["a", "b"]
    one = np.sqrt((9 + 16 + 25) / 3)
    assert ranking["mu_c"].tolist() == pytest.approx([np.sqrt(one * 0.1), 4.0])  # 0.1 % is the floor
    assert ranking["score"][1] == pytest.approx((4.0 * 10.0 * 1.0) ** (1 / 3))
    assert ranking["worst"].tolist() == [10.0, 10.0]
    assert winners(table)["mu_c"].tolist() == ["a (4.1 %)", "a (0.0 %)"]


def test_truth_follows_the_load():
    course = swinging(0.31, 1 / 3)
    normal, mu_c, r = (np.array([point[k] for point in course.points]) for k in (3, 4, 6))
    assert normal.max() / normal.min() > 2.5
    np.testing.assert_allclose(mu_c, MU_C * (normal / 5.0) ** -0.31)
    np.testing.assert_allclose(r, R * (normal / 5.0) ** (1 / 3))


def test_single_imperfections_are_all_that_differs_between_the_presets():
    lab, realistic = (load(sensors=name).sensors.model_dump() for name in ("lab", "realistic"))
    each = [(s, name) for s, own in lab.items() if isinstance(own, dict) for name in own]
    differ = {(s, name) for s, name in each if lab[s][name] != realistic[s][name]}
    listed = [(s, name) for case in IMPERFECTIONS.values() for s, names in case.items() for name in names]
    assert sorted(listed) == sorted(differ)


def test_sensors_without_some_imperfections():
    overrides = without(["scale", "late-velocity"])
    sensors = load(overrides, sensors="lab").sensors
    assert (sensors.slip.scale_error, sensors.slip.latency_samples, sensors.slip.latency_spread) == (
        0.0,
        1,
        0,
    )
    assert sensors.force_torque == load(sensors="lab").sensors.force_torque
    assert without(list(IMPERFECTIONS))["sensors"] != {}
    everything = load(without(list(IMPERFECTIONS)), sensors="lab").sensors
    assert everything == load(sensors="realistic").sensors
    assert without([]) == {}
    with pytest.raises(ValueError, match="imperfection"):
        without(["weather"])


@pytest.mark.slow
def test_every_group_gives_scenarios_that_judge_something():
    scenarios = [scenario for group in GROUPS for scenario in group(QUICK)]
    assert len({(scenario.group, scenario.name) for scenario in scenarios}) == len(scenarios)
    for scenario in scenarios:
        for run in scenario.runs:
            assert run.evaluated
            assert set(run.evaluated) <= set(FIELDS)
            assert all(at.any() for at in run.evaluated.values())
        if scenario.starts:
            assert {values[0] for values in scenario.starts.values()} == {R, MU_C}
            assert all(len(run.record.wrenches) == 10 for run in scenario.runs)


def test_closed_loop_slips_are_short_and_stuck_samples_are_called_moving(leap):
    """The mechanism that drags mu_c down: a late, averaged velocity beside a force of now."""
    edges = np.flatnonzero(np.diff(np.append(np.append(0, leap.phase == "slip"), 0)))
    lengths = (edges[1::2] - edges[::2]) / 120
    assert 0.03 < np.median(lengths) < 0.08
    speed = np.hypot(*leap.motion[:, :2].T) * 120
    called = np.append(0.0, speed[:-1]) > 1.5e-3
    ratio = np.hypot(*leap.wrench[:, :2].T) / leap.normal
    stuck = called & (ratio < 0.97 * leap.mu_c)
    assert 0.15 < stuck.sum() / called.sum() < 0.5
    assert leap.normal[stuck].mean() > 1.2 * leap.normal[called & ~stuck].mean()


def test_truth_of_a_closed_loop_trial_is_its_own_friction_law(leap):
    """While it slides, force over normal force is mu_c + sigma_2 v; grip force is what the pad feels."""
    speed = np.hypot(*leap.twist[:, :2].T)
    sliding = speed > 0.02
    assert sliding.sum() > 20
    ratio = np.hypot(*leap.wrench[:, :2].T) / leap.normal
    off = np.abs(ratio / (leap.mu_c[0] + 0.2 * speed) - 1.0)
    # friction is of the middle of a sub-step of 0.25 ms, grip of its end; its rate there is at most the
    # larger of the mean ones before and after the sample
    rate = np.abs(np.diff(leap.normal) / np.diff(leap.t))
    rate = np.maximum(np.append(0.0, rate), np.append(rate, 0.0))
    assert (off <= 1.25e-4 * rate / leap.normal + 2e-4)[sliding].all()
    assert np.median(off[sliding]) < 3e-3


def test_stick_slip_tells_the_estimators_apart():
    stick_slip = next(group for group in GROUPS if group.__name__ == "stick_slip")
    scenario = next(stick_slip(replace(QUICK, trials=((0.04, 2.0),))))
    found = {row["estimator"]: row for row in evaluate(scenario)}
    assert found["rls, plain"]["bias_mu_c"] < -30.0
    assert 0.0 < found["rls"]["bias_mu_c"] < 20.0
    assert found["joint"]["error_mu_c"] < 4.0
    pd.testing.assert_frame_equal(pd.DataFrame(evaluate(scenario)), pd.DataFrame(found.values()))


@pytest.mark.slow
def test_the_command_writes_what_it_names(tmp_path):
    folder = run_leaderboard(tmp_path, quick=True, progress=False)
    names = {"versions.json", "leaderboard.md", "ranking.csv", "scenarios.csv", "leaderboard.png"}
    assert {path.name for path in folder.iterdir()} == names
    table, ranking = (pd.read_csv(folder / f"{name}.csv") for name in ("scenarios", "ranking"))
    assert set(ranking["estimator"]) == set(entrants())
    assert table.groupby("estimator").size().nunique() == 1
    assert ranking["worst"].is_monotonic_increasing
    page = (folder / "leaderboard.md").read_text()
    assert all(f"\n## {field}\n" in page for field in FIELDS)


def test_an_own_estimator_is_entered_and_a_wrong_one_refused_at_once(tmp_path, monkeypatch):
    own = "own_friction:OWN"
    module = SimpleNamespace(OWN=replace(specification("rls"), name=own))
    monkeypatch.setitem(sys.modules, "own_friction", module)
    assert entrants([own])[own] == (own, {})
    with pytest.raises(ValueError, match="no_such"):
        run_leaderboard(tmp_path / "runs", quick=True, progress=False, own=["no_such_package:SPECIFICATION"])
    assert not (tmp_path / "runs").exists()
