import dataclasses
import math

import gymnasium as gym
import numpy as np
import pandas as pd
import pytest

from policies.evaluation.metrics import MEASURES, measure
from policies.evaluation.recording import INFOS, Recorder, Recording, needed_force
from policies.evaluation.tables import markdown, summarise
from slipgym.tasks import TASKS


def recording(**changes):
    """Ten steps that slide 1 mm ahead of a reference going from 1 to 10 mm; cruise in the steps 2 to 7."""
    position = np.linspace(0.001, 0.010, 10)
    slip = np.zeros((10, 3))
    slip[:, 1] = -(position + 0.001)
    slip[4] += 0.0003, 0.0, 0.1
    acceleration = np.array([1, 1, 0, 0, 0, 0, 0, 0, -1, -1], dtype=float)
    estimated = np.zeros((10, 2, 3))
    estimated[:] = 1.3
    estimated[2:8, 0], estimated[2:8, 1] = 0.3, 0.5
    estimated[9] = (0.6, 0.4, 0.012), (0.4, 0.2, 0.008)
    values = {
        "time": np.arange(1, 11) / 120,
        "slip": slip,
        "reference": np.column_stack((position, np.ones(10), acceleration)),
        "grip_force": np.tile([4.0, 6.0], (10, 1)),
        "needed_force": np.array([2.0] * 9 + [4.0]),
        "estimated": estimated,
        "true": np.array([0.55, 0.35, 0.010]),
        "reward": np.full(10, 0.1),
        "goal": 0.012,
        "success": True,
        "dropped": False,
        "drawn": {},
    }
    return Recording(**{**values, **changes})


def test_every_task_has_measures():
    assert set(MEASURES) == set(TASKS)


def test_linear_slip_measures():
    row = measure(recording(), "LinearSlip")
    assert row["final_error_mm"] == pytest.approx(-1.0)
    assert row["final_error_abs_mm"] == pytest.approx(1.0)
    assert row["rms_error_mm"] == pytest.approx(1.0)
    assert row["max_sideways_mm"] == pytest.approx(0.3)
    assert row["max_rotation_deg"] == pytest.approx(math.degrees(0.1))
    assert row["mean_force_N"] == pytest.approx(5.0)
    assert row["return"] == pytest.approx(1.0)
    assert row["cruise_mu_c"] == pytest.approx(0.4)
    assert (row["final_mu_s"], row["final_mu_c"], row["final_r_mm"]) == pytest.approx((0.5, 0.3, 10.0))
    assert (row["true_mu_s"], row["true_mu_c"], row["true_r_mm"]) == pytest.approx((0.55, 0.35, 10.0))
    assert row["success"] is True
    assert row["dropped"] is False


def test_a_drop_before_the_cruise_has_no_cruise_estimate():
    still = dataclasses.replace(recording(), reference=np.zeros((10, 3)))
    assert math.isnan(measure(still, "LinearSlip")["cruise_mu_c"])


def test_rotational_slip_measures():
    """Half a degree behind a reference of 1 to 10 degrees, 0.1 of a degree short of the goal in the end."""
    position = np.radians(np.arange(1.0, 11.0))
    slip = np.zeros((10, 3))
    slip[:, 2] = -(position - math.radians(0.5))
    slip[4, :2] = 0.0003, -0.0004
    reference = np.column_stack((position, np.ones((10, 2))))
    goal = math.radians(9.6)
    row = measure(recording(slip=slip, reference=reference, goal=goal), "RotationalSlip")
    assert row["final_error_deg"] == pytest.approx(-0.1)
    assert row["final_error_abs_deg"] == pytest.approx(0.1)
    assert row["rms_error_deg"] == pytest.approx(0.5)
    assert row["largest_slip_mm"] == pytest.approx(0.5)


def test_hinge_measures():
    """The object turns in the grip against the wrist and falls 3 degrees behind."""
    pitch = -np.radians(np.arange(0.0, 10.0))
    slip = np.zeros((10, 3))
    slip[:, 2] = -pitch
    slip[6, 2] -= math.radians(3.0)
    slip[7, :2] = 0.0003, -0.0004
    reference = np.column_stack((pitch, np.ones((10, 2))))
    row = measure(recording(slip=slip, reference=reference), "Hinge")
    assert row["largest_tilt_deg"] == pytest.approx(3.0)
    assert row["largest_slip_mm"] == pytest.approx(0.5)


def test_planar_slip_measures():
    """0.5 mm and 2 degrees beside a target that is reached at the end alone."""
    slip, target = np.zeros((10, 3)), np.array([0.01, -0.004, math.radians(-20.0)])
    slip[-1] = target + np.array([0.0003, -0.0004, math.radians(-2.0)])
    row = measure(recording(slip=slip, reference=np.tile(target, (10, 1))), "PlanarSlip")
    assert row["final_error_mm"] == pytest.approx(0.5)
    assert row["final_error_deg"] == pytest.approx(-2.0)
    assert row["final_error_abs_deg"] == pytest.approx(2.0)
    assert [row["target_x_mm"], row["target_y_mm"], row["target_theta_deg"]] == pytest.approx(
        [10.0, -4.0, -20.0]
    )


def test_pivot_to_measures():
    """2 degrees short of 40 in the end, 0.5 mm of slide in between."""
    slip = np.zeros((10, 3))
    slip[:, 2] = np.radians(np.linspace(0.0, 38.0, 10))
    slip[4, :2] = 0.0003, -0.0004
    row = measure(recording(slip=slip, goal=math.radians(40.0)), "PivotTo")
    assert row["final_error_deg"] == pytest.approx(-2.0)
    assert row["final_error_abs_deg"] == pytest.approx(2.0)
    assert row["target_theta_deg"] == pytest.approx(40.0)
    assert row["largest_slip_mm"] == pytest.approx(0.5)


def test_tolerances_are_options_of_their_task():
    for name, measures in MEASURES.items():
        for limit in measures.tolerances:
            assert limit.option in TASKS[name].options.model_fields


def test_hold_measures():
    slip = np.zeros((10, 3))
    slip[3, :2] = 0.0003, -0.0004
    row = measure(recording(slip=slip), "Hold")
    assert row["largest_slip_mm"] == pytest.approx(0.5)
    assert row["needed_force_mean_N"] == pytest.approx(2.2)
    assert row["needed_force_peak_N"] == pytest.approx(4.0)
    assert row["force_ratio"] == pytest.approx(5.0 / 2.2)
    assert row["allowed_force_N"] == pytest.approx(0.010)  # of `reference`


def test_where_hold_allows_any_grip_its_tables_have_no_column_for_it():
    for allowed, there in ((3.0, True), (0.0, False)):
        rows = [measure(recording(reference=np.tile([allowed, 1.0, 0.0], (10, 1))), "Hold")] * 3
        keys = {"policy": "hold", "friction": "true", "material": "wood", "options": "", "trial": range(3)}
        summary = summarise(pd.DataFrame(rows).assign(**keys), "Hold")
        page = markdown(summary, "Hold", 3)
        assert ("| allowed, mean [N] |" in page) == there
        assert (" 3.00 |" in page) == there


def test_fragile_hold_measures():
    """A grip of 5 N where 4 N hold and 8 N break."""
    row = measure(recording(reference=np.tile([8.0, 4.0, 0.0], (10, 1))), "FragileHold")
    assert (row["breaking_force_N"], row["least_force_N"]) == (8.0, 4.0)
    assert row["peak_force_ratio"] == pytest.approx(5.0 / 8.0)
    assert row["force_ratio"] == pytest.approx(5.0 / 4.0)


def test_carry_measures():
    """A grip of 5 N where 4 N are the mean of the least and 6.4 N are allowed."""
    row = measure(recording(reference=np.tile([6.4, 4.0, 7.0], (10, 1))), "Carry")
    assert (row["allowed_force_N"], row["least_force_mean_N"], row["least_force_peak_N"]) == (6.4, 4.0, 7.0)
    assert row["force_ratio"] == pytest.approx(5.0 / 4.0)


def test_needed_force_lies_on_the_ellipsoid():
    mu_s, r = 0.6, 0.010
    wrench = np.array([[[1.0, -2.0, 0.012], [3.0, -4.0, 0.004]]])
    (force,) = needed_force(wrench, np.array([[mu_s, 0.5, r]]))
    f_x, f_y, tau = 2.0, -3.0, 0.008
    limit = mu_s * force
    assert (f_x / limit) ** 2 + (f_y / limit) ** 2 + (tau / (limit * r)) ** 2 == pytest.approx(1.0)


def test_series_have_the_friction_that_the_controller_was_shown():
    """The truth, the nominal values or nothing, whatever the estimators say."""
    shown = {}
    for source in ("true", "nominal", "none"):
        made = gym.make("slipgym/Hold-v0", engine="planar", friction_source=source, disable_env_checker=True)
        made.reset(seed=0)
        recorder = Recorder([column.name for column in made.unwrapped.columns], [{}])
        step = made.step(made.action_space.sample())
        infos = {name: np.asarray(value)[None] for name, value in step[4].items() if name in INFOS}
        recorder.add(step[0][None], np.zeros(1), infos, np.ones(1, dtype=bool))
        (kept,) = recorder.finish()
        shown[source] = [kept.series()[f"shown_{name}"][0] for name in ("mu_s", "mu_c")]
        true = kept.true[:2]
    nominal = made.unwrapped.config.nominal
    assert shown["true"] == pytest.approx(true, rel=1e-5)
    assert shown["nominal"] == pytest.approx((nominal.mu_s, nominal.mu_c))
    assert np.isnan(shown["none"]).all()
    assert np.isnan(recording().series()["shown_mu_c"]).all()


def test_series_has_a_row_per_step():
    series = recording().series()
    assert {len(column) for column in series.values()} == {10}
    np.testing.assert_allclose(series["mu_c_2"][2:8], 0.5)
    np.testing.assert_allclose(series["force_2"], 6.0)
