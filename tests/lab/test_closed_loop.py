"""Estimators in the loop: what the table says of them."""

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from lab.leaderboard.closed_loop import played, pooled, present
from policies.commands.front import application
from slipgym.contact.records import pads


def test_the_truth_is_that_of_the_present_load_and_age():
    pad = pads((1, 2), mu_c=0.4, mu_s=0.5, r=0.01)
    pad["friction_scale"], pad["static_gain"], pad["radius"] = 0.9, 2.0, 0.011
    truth = present(pad)
    assert truth["mu_c"] == pytest.approx(0.36)
    assert truth["mu_s"] == pytest.approx(0.36 + 0.9 * 2.0 * 0.1)
    assert truth["r"] == pytest.approx(0.011)


@pytest.mark.slow
def test_the_leaderboard_of_policies_takes_an_estimator_of_ones_own(tmp_path):
    """Without the laboratory it says what the controllers solve with it."""
    words = ["hold", "--level", "easy", "--episodes", "2", "--output", str(tmp_path)]
    own = "lab.learned_estimator.gru:SPECIFICATION"
    done = CliRunner().invoke(application("policy-leaderboard"), [*words, "--estimator", own])
    assert done.exit_code == 0, done.output
    assert "| Hold | easy | controller, estimated |" in done.output


@pytest.mark.slow
def test_ideal_sensors_are_learned_from_and_solved_with():
    row = played("slipgym/LinearSlip-v0", 16, 0, estimator="rls", sensors="ideal")
    assert row["solved"] >= 90.0
    assert row["dropped"] == 0.0
    assert row["mu_c error"] < 5.0
    assert 0.0 <= row["mu_c in 1 sd"] <= row["mu_c in 2 sd"] <= 100.0
    assert np.isnan(row["r error"])  # it does not turn
    assert row["reversed"] == 0.0


def test_pooled_shares_count_a_task_by_its_episodes_and_its_own_controller_only():
    row = {"estimator": "adaptive", "sensors": "lab", "mu_s episodes": 0, "mu_s in 1 sd": np.nan}
    row |= {f"{name} in 2 sd": 100.0 for name in ("mu_s", "mu_c", "r")} | {
        "r episodes": 0,
        "r in 1 sd": np.nan,
    }
    shares = {"Hold": (10, 50.0), "Hinge": (30, 90.0), "linear_slip_leaps": (60, 0.0)}
    table = pd.DataFrame(
        [
            row | {"task": task, "mu_c episodes": n, "mu_c in 1 sd": share}
            for task, (n, share) in shares.items()
        ]
    )
    found = pooled(table).set_index("quantity")
    assert found.loc["mu_c", ["episodes", "in 1 sd", "in 2 sd"]].tolist() == [40, 80.0, 100.0]
    assert found.loc["mu_c", "± in 1 sd"] == pytest.approx(100.0 * np.sqrt(10 * 0.25 + 30 * 0.09) / 40)
    assert np.isnan(found.loc["mu_s", "in 1 sd"])


@pytest.mark.slow
def test_adaptive_finds_the_friction_of_planar_slip_on_either_surface():
    """Slips of all directions at 1.5 to 5 N tell it at the 20 N that hold the object afterwards."""
    for contact, error in (("ellipsoid", 6.0), ("disc", 3.0)):
        row = played(
            "slipgym/PlanarSlip-v0", 48, 0, estimator="adaptive", sensors="realistic", contact=contact
        )
        assert row["mu_c seen error"] < error
        assert row["r seen error"] < 6.0


@pytest.mark.slow
@pytest.mark.xfail(reason="8.4 and 7.1 % instead of 6 %: a spring is bounded less tightly", strict=True)
@pytest.mark.parametrize("contact", ["ellipsoid", "disc"])
def test_errors_of_the_sensors_do_not_pass_for_an_exponent_of_the_load(contact):
    """With "lab" sensors mu_c of hard pads is that of the slips, also at the 20 N of the last grip."""
    row = played("slipgym/PlanarSlip-v0", 96, 0, estimator="adaptive", sensors="lab", contact=contact)
    assert row["mu_c seen error"] < 6.0


@pytest.mark.slow
@pytest.mark.parametrize(("contact", "error"), [("ellipsoid", 12.0), ("disc", 6.0)])
def test_a_hinge_slips_slowly_and_shows_mu_c_all_the_same(contact, error):
    """Slips at 0.9 mm/s, where almost half of the friction above mu_c is left."""
    row = played("slipgym/Hinge-v0", 48, 0, estimator="adaptive", sensors="realistic", contact=contact)
    assert row["mu_c seen error"] < error


@pytest.mark.slow
def test_a_turn_in_planar_slip_that_goes_astray_does_not_end_in_a_fall():
    """On rubber a turn often slides on; without a limit one object in six falls."""
    row = played("slipgym/PlanarSlip-v0", 64, 0, estimator="adaptive", sensors="lab", randomization="lab")
    assert row["dropped"] == 0.0


def test_on_rubber_a_spring_of_the_pad_is_no_slip():
    """Hold with the cheap sensors, whose chips sleep: shakes spring the pad under loads far below friction.

    95 % within two deviations would be right; at 57 to 64 % nearly every hold had such slips.
    """
    row = played("slipgym/Hold-v0", 128, 50000, estimator="adaptive", sensors="lab", randomization="lab")
    assert row["mu_c in 2 sd"] > 70.0
    assert row["r in 2 sd"] > 85.0
