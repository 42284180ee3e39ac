"""The planar trials on other pads: what is drawn, what is read, and what the table says."""

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import estimator
from lab.commands.reproduce import app
from lab.reproduction import pads as module
from lab.reproduction import reproduce_planar_pads
from lab.reproduction.mechanism import truly_sliding
from lab.reproduction.pads import PADS, SHIFT, SOFT, Pads, at_the_centre, overrides
from lab.reproduction.planar import record_planar, scenarios
from slipgym.config import load_randomization
from slipgym.config.pad import EFFECTS

SCENARIO = {"material": "wood", "trial": 0, "seed": 5}


@pytest.fixture(scope="module")
def record():
    pads = PADS["Hertz, soft, shifted"]
    return record_planar(SCENARIO, "ellipsoid", overrides(pads, SCENARIO["seed"]))


def test_every_effect_of_a_pad_is_soft_or_a_shift():
    assert set(SOFT) | set(SHIFT) == {*EFFECTS, "cop_offset"}


def test_pads_of_one_trial_share_what_is_drawn():
    """The row with all effects is that of the single ones together."""
    soft, shifted, both = (
        overrides(Pads(soft=soft, shifted=shifted), 3)["contact"]
        for soft, shifted in ((True, False), (False, True), (True, True))
    )
    assert both["pad"] == {**soft["pad"], **shifted["pad"]}
    assert both["cop_offset"] == shifted["cop_offset"]
    assert soft["pad"].keys() == set(SOFT)
    assert overrides(Pads(), 3) == {"contact": {"pressure": "uniform", "pad": {}}}
    assert overrides(Pads(soft=True), 4)["contact"] != soft
    ranges = load_randomization("lab")
    for name, value in both["pad"].items():
        low, high = getattr(ranges, name).ends
        assert low <= value <= high


def test_rigid_pads_are_those_of_the_planar_experiment():
    """The same trial, bit for bit."""
    plain = record_planar(SCENARIO, "ellipsoid")
    again = record_planar(SCENARIO, "ellipsoid", overrides(PADS["ellipsoid"], SCENARIO["seed"]))
    np.testing.assert_array_equal(again.wrenches, plain.wrenches)
    np.testing.assert_array_equal(plain.friction, np.tile(plain.truth, (len(plain.time), 1)))
    np.testing.assert_array_equal(plain.centres, 0.0)


def test_friction_and_centre_of_pressure_are_those_of_each_sample(record):
    drawn = overrides(PADS["Hertz, soft, shifted"], SCENARIO["seed"])["contact"]
    f_n = record.wrenches[..., 2].mean(axis=1)
    slides = truly_sliding(record)
    slope = np.polyfit(np.log(f_n[slides]), np.log(record.friction[slides, 1]), 1)[0]
    # the force sensor's noise and age blur the load: a tenth of the exponent
    assert slope == pytest.approx(-drawn["pad"]["load_exponent"], abs=0.03)
    off = record.centres - np.array(drawn["cop_offset"])
    lever = np.linalg.norm(off[slides], axis=-1).mean(axis=1)
    load = np.hypot(record.wrenches[..., 0], record.wrenches[..., 1]).mean(axis=1)[slides] / f_n[slides]
    assert np.median(lever / load) == pytest.approx(drawn["pad"]["cop_lever"], rel=0.05)


def test_at_the_centre_the_same_motion_has_the_same_power(record):
    moved = at_the_centre(record)

    def power(each):
        return (each.wrenches[..., [0, 1, 3]] * each.twists).sum(axis=-1)

    np.testing.assert_allclose(power(moved), power(record), rtol=1e-9, atol=1e-12)
    assert np.abs(moved.wrenches[..., 3] - record.wrenches[..., 3]).max() > 1e-4


def test_the_table_has_a_row_for_all_pads_and_a_column_for_all_estimators(tmp_path, monkeypatch):
    few = {"ellipsoid": Pads("ellipsoid"), "shifted": Pads("ellipsoid", shifted=True)}
    monkeypatch.setattr(module, "PADS", few)
    monkeypatch.setattr(module, "scenarios", lambda trials, seed: scenarios(trials, seed)[:2])
    folder = reproduce_planar_pads(tmp_path, trials=1, progress=False)
    assert {path.name for path in folder.iterdir()} == {
        "trials.csv",
        "table.md",
        "settings.yaml",
        "versions.json",
    }
    page = (folder / "table.md").read_text(encoding="utf-8")
    for title in ("## Error of r [%]", "## Error of mu_c [%]", "## r [mm]"):
        heading = page.partition(f"{title}\n\n")[2].partition("\n")[0]
        assert all(f" {name} " in heading or f" {name}, " in heading for name in estimator.names())
    assert page.count("\n| shifted, read at the pad's centre |") == 3
    table = pd.read_csv(folder / "trials.csv")
    own = table[(table["pads"] == "ellipsoid") & (table["estimator"] == "joint")]
    # the model's own surface: noise alone, as in the planar experiment
    assert own[own["quantity"] == "r"]["error"].abs().max() < 0.03


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--pads", "--contact", "ellipsoid"], "--pads has contacts of its own"),
        (["--pads", "--trials", "0"], "--trials"),
    ],
)
def test_wrong_options_are_a_usage_error(words, message):
    done = CliRunner().invoke(app, ["planar", *words])
    assert done.exit_code == 2
    assert message in done.output


def test_no_trials_are_an_error(tmp_path):
    with pytest.raises(ValueError, match="trials = 0 must be at least 1"):
        reproduce_planar_pads(tmp_path, trials=0, progress=False)
    assert not list(tmp_path.iterdir())
