import numpy as np
import pandas as pd
import pytest

from policies.evaluation.frames import where
from policies.evaluation.statistics import over_seeds, share_interval
from policies.study.tables import ALL, benefits, outcomes, shares, transfer
from policies.study.terminal import claims, training_seeds

BULLET, CORE = "PyBullet, ellipsoid", "core"
CLEAR = {"none": 2, "estimated": 9, "true": 10}


def one(table, **equals):
    rows = where(table, **equals)
    assert len(rows) == 1
    return rows.iloc[0]


def test_outcomes_of_known_episodes(invented):
    row = one(outcomes(invented(CLEAR)), source="none")
    assert (row["n"], row["task"], row["blocks"]) == (30, "Hold", "0.200 0.200 0.200")
    assert (row["success"], row["success_low"], row["success_high"]) == share_interval(6, 30)
    assert row["dropped"] == pytest.approx(4 / 10)  # episodes 3, 5, 7, 9
    assert row["return_low"] <= row["return"] <= row["return_high"]


@pytest.mark.parametrize(
    ("solved", "verdict", "share"),
    [
        (CLEAR, "yes", 7 / 8),
        ({"none": 2, "estimated": 6, "true": 10}, "no", 0.5),
        ({"none": 2, "estimated": 10, "true": 2}, "not significant", np.nan),
        ({"none": 10, "estimated": 9, "true": 2}, "the truth does harm", np.nan),
    ],
)
def test_the_share_and_its_verdict(invented, solved, verdict, share):
    row = one(shares(invented(solved), "disc"), figure="success")
    assert row["verdict"] == verdict
    assert row["share"] == pytest.approx(share, nan_ok=True)
    assert row["true-none"] == pytest.approx((solved["true"] - solved["none"]) / 10)
    if verdict in ("yes", "no"):
        assert row["share_low"] < row["share"] < row["share_high"]


def test_a_single_episode_is_never_significant(invented):
    few = invented(CLEAR).query("episode == 5")
    assert set(shares(few, "disc")["verdict"]) == {"not significant"}


def test_there_is_no_share_without_all_three(invented):
    assert len(shares(invented({"none": 2, "estimated": 9}), "disc")) == 0
    assert len(shares(invented(CLEAR), "joint")) == 0


def test_all_tasks_are_those_that_have_every_source(invented):
    partial = invented({"estimated": 0}, task="LinearSlip")
    other = invented({"none": 4, "estimated": 5, "true": 6}, task="Hinge")
    table = pd.concat([invented(CLEAR), other, partial], ignore_index=True)
    together = where(outcomes(table), task=ALL)
    assert list(together["source"]) == ["none", "estimated", "true"]
    np.testing.assert_allclose(together["success"], [0.3, 0.7, 0.8])
    assert together["return"].isna().all()
    assert one(shares(table, "disc"), task=ALL)["share"] == pytest.approx(0.8)


def test_the_change_of_engine_over_pairs(invented, small):
    here = invented({"estimated": 10}, world=CORE)
    there = invented({"estimated": 8}).sample(frac=1.0, random_state=0)
    row = one(transfer(pd.concat([here, there], ignore_index=True), small()))
    assert (row["core"], row["bullet"]) == (100.0, pytest.approx(80.0))
    assert row["difference"] == pytest.approx(-20.0)
    assert row["difference_low"] < -20.0 < row["difference_high"] < 0.0
    assert row["n"] == 30


def test_the_sentence_names_the_strongest_policy_without_friction(invented):
    recurrent = invented({"none": 6}, kind="recurrent")
    table = pd.concat([invented(CLEAR), recurrent, invented({"none": 5}, kind="memory")], ignore_index=True)
    (said,) = claims(benefits(table), outcomes(table))
    assert said.startswith(
        "Hold, train: Of 30 episodes, 27 are solved with estimated friction, 18 by the strongest policy "
        "without friction (recurrent network), 30 with the truth. The estimate gains 30 points ("
    )


def test_nominal_friction_and_a_constant_grip_are_without_friction(invented):
    grip = invented({"none": 7}, kind="constant")
    for table, name, solved in (
        (invented({**CLEAR, "nominal": 5}), "controller, nominal friction", 15),
        (pd.concat([invented(CLEAR), grip], ignore_index=True), "best constant grip", 21),
    ):
        (said,) = claims(benefits(table), outcomes(table))
        assert f", {solved} by the strongest policy without friction ({name})" in said


def test_the_benefit_is_against_the_strongest_policy_without_friction(invented):
    learned = invented({"none": 6, "estimated": 9}, kind="imitation")
    table = benefits(pd.concat([invented(CLEAR), learned], ignore_index=True))
    assert set(table["opponent"]) == {"imitation"}
    assert set(zip(table["kind"], table["source"], strict=True)) == {
        ("classic", "estimated"),
        ("classic", "true"),
        ("imitation", "estimated"),
    }
    row = one(table, kind="classic", source="true")
    assert (row["difference"], row["share"], row["verdict"]) == (pytest.approx(0.4), 1.0, "better")
    few = benefits(invented({"none": 2, "estimated": 3, "true": 10}))
    assert one(few, source="estimated")["share"] == pytest.approx(1 / 8)
    nominal = one(benefits(invented({"none": 4, "nominal": 5, "estimated": 5})))
    assert (nominal["opponent"], nominal["verdict"]) == ("classic nominal", "not resolvable")
    assert len(benefits(invented({"true": 10}))) == 0


def test_a_share_with_a_wide_interval_is_not_stated(invented):
    wide = one(benefits(invented({"none": 4, "estimated": 5, "true": 6})), source="estimated")
    assert np.isnan(wide["share"])
    worse = one(benefits(invented({"none": 10, "estimated": 2, "true": 2})), source="estimated")
    assert worse["verdict"] == "worse"
    assert np.isnan(worse["share"])


def test_the_mean_over_seeds_leaves_the_extremes_out(invented):
    assert over_seeds([0.0, 0.5, 0.6, 0.7, 1.0]).value == pytest.approx(0.6)
    one_seed = over_seeds([0.5])
    assert one_seed.value == 0.5
    assert np.isnan(one_seed.low)
    rows = outcomes(pd.concat([invented(CLEAR), invented({"none": 6}, kind="imitation")]))
    assert one(rows, kind="imitation")["seeds"] == pytest.approx(0.6)
    said = "".join(training_seeds(rows))
    assert said.count("60 60 60") == 1
    assert "classic" not in said
    assert training_seeds(outcomes(invented(CLEAR))) == []
    assert where(rows, kind="classic")["seeds"].isna().all()
