"""What is worth which state and test of "adaptive", and late velocities."""

from dataclasses import fields, replace

import numpy as np
import pandas as pd
import pytest

import estimator
from lab.leaderboard import ablation
from lab.leaderboard.ablation import FULL, WITHOUT, worth
from lab.leaderboard.delays import delays
from lab.leaderboard.opened import opened
from policies.leaderboard.run import evaluate
from policies.leaderboard.scenario import FIELDS
from policies.leaderboard.scenarios import QUICK


@pytest.mark.slow
def test_late_velocities_have_a_row_for_each_material_and_delay():
    found = delays(replace(QUICK, materials=("wood", "case")))
    assert len(found) == 8
    assert (found["mean error"].abs() <= found["largest"]).all()
    assert found["within 5 %"].between(0.0, 100.0).all()


def test_each_ablation_changes_known_parameters():
    known = {field.name for field in fields(estimator.AdaptiveParameters)}
    for removed in WITHOUT.values():
        assert set(removed) <= known
        estimator.AdaptiveParameters.create(**removed)


def test_the_loop_is_averaged_over_tasks(monkeypatch):
    def played(choices, episodes, sensors, seed):
        assert choices[FULL] == {"name": "adaptive"}
        figures = {"dropped": 0.0, "mu_s in 1 sd": 5.0, "mu_c in 1 sd": 60.0, "r in 1 sd": np.nan}
        return pd.DataFrame(
            {"estimator": name, "solved": solved, "mu_c error": error, "mu_s error": 5.0, **figures}
            for name in choices
            for solved, error in ((50.0, 2.0), (100.0, 8.0), (75.0, np.nan))
        )

    monkeypatch.setattr(ablation, "closed_loop", played)
    found = ablation.in_the_loop(2, 0)
    assert found["without"].tolist() == list(WITHOUT)
    np.testing.assert_allclose(found[["solved", "mu_c error", "mu_s error"]].to_numpy()[0], (75.0, 4.0, 5.0))


def test_an_open_gripper_shows_zero_errors_and_the_ablation_what_that_is_worth():
    (scenario,) = opened(QUICK)
    chosen = {
        label: ("adaptive", WITHOUT[label]) for label in (FULL, "zeroing while unloaded", "short slips")
    }
    rows = evaluate(scenario, chosen)
    assert [row["estimator"] for row in rows] == list(chosen)
    full, blind, same = (row["error_mu_c"] for row in rows)
    assert full == same < 2.0 < blind
    blank = {f"{figure}_{field}": 0.0 for field in FIELDS for figure in ("calibration", "time")}
    table = pd.DataFrame([{**blank, **row, "error_mu_s": 1.0} for row in rows])
    found = worth(table)
    assert found["without"].tolist() == [FULL, "zeroing while unloaded", "short slips"]
    assert found["loses most"].tolist()[1] == f"open gripper, mu_c: {full:.1f} → {blind:.1f}"
    assert found["loses most"].tolist()[::2] == ["–", "–"]
