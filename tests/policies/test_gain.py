from typing import Any

import numpy as np
import pandas as pd
import pytest

from policies import make
from policies.evaluation import evaluate, load_experiment, narrowed, report
from policies.evaluation.gain import TRUTH, WITHOUT, against_truth, compare
from policies.evaluation.plan import plan
from policies.evaluation.play import Played
from policies.evaluation.statistics import mean_interval
from policies.evaluation.trial import environment, make_policy, run_trial
from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import worth
from policies.study.tables import benefits

SOLVED = {
    ("controller", "nominal"): 6,
    ("memory of slips", "none"): 3,
    ("recurrent network", "none"): 5,
    ("controller", "estimated"): 8,
    ("controller", "true"): 9,
}


def table(solved, n=10):
    """Trials of which each policy solves the first ones."""
    rows = [
        {
            "policy": policy,
            "friction": source,
            "friction_source": source,
            "material": "random",
            "options": "{}",
            "trial": trial,
            "success": trial < count,
            "return": float(trial < count),
        }
        for (policy, source), count in solved.items()
        for trial in range(n)
    ]
    return pd.DataFrame(rows)


def test_the_opponent_is_the_strongest_without_friction():
    gain = compare(table(SOLVED))
    assert gain is not None
    assert [entry.source for entry in gain.entries] == ["none", "none", "nominal", "estimated", "true"]
    assert gain.words().startswith(
        "Of 10 episodes, 8 are solved with estimated friction, 6 by the strongest policy without friction "
        "(controller, nominal friction), 9 with the truth. The estimate gains 20 points ("
    )
    paired = mean_interval(np.array([0.0] * 6 + [100.0] * 2 + [0.0] * 2))
    assert gain.points == pytest.approx(paired)


def test_evaluations_studies_and_the_leaderboard_state_the_same_interval():
    trials = table({("a", "none"): 3, ("b", "estimated"): 8, ("b", "true"): 9}, n=12)
    gain = compare(trials)
    assert gain is not None
    own, zero = make("hold"), np.zeros(12)
    members = [Member(each.source, own, {"friction_source": each.source}) for each in gain.entries]
    played = {each.source: Played(each.success, zero, each.reward, zero, zero) for each in gain.entries}
    row = worth("hold", "hard", members, played)
    assert gain.points.low < gain.points.value < gain.points.high
    assert gain.points == (row["gain"], row["low"], row["high"])
    place = {"world": "core", "task": "Hold", "preset": "train", "change": "", "block": 0}
    names = {"policy": "kind", "friction": "source", "trial": "episode"}
    found = benefits(trials.rename(columns=names).assign(**place, estimator=""))
    ends = ["difference", "difference_low", "difference_high"]
    (points,) = found.loc[found["source"] == "estimated", ends].to_numpy()
    assert gain.points == pytest.approx(tuple(100.0 * points))


def test_the_estimate_is_compared_with_the_truth_episode_by_episode():
    trials = table({("a", "none"): 1, ("b", "estimated"): 7, ("b", "true"): 6, ("c", "true"): 9})
    solved = (trials["friction"] == "true") & (trials["policy"] == "b") & (trials["trial"] == 9)
    trials.loc[solved, "success"] = True  # the truth alone solves it
    (row,) = against_truth(trials.sample(frac=1.0, random_state=0)).itertuples(index=False, name=None)
    assert row[:6] == ("b", "estimated", 6, 1, 1, 2)
    assert row[6].startswith("0 (-")
    assert len(against_truth(trials.loc[trials["policy"] != "b"])) == 0


def test_an_estimate_that_solves_fewer_loses():
    gain = compare(table({("a", "none"): 9, ("b", "estimated"): 6}))
    assert gain is not None
    assert "6 are solved with estimated friction, 9 by the strongest" in gain.words()
    assert "with the truth" not in gain.words()
    assert "The estimate loses 30 points (" in gain.words()


def test_a_single_episode_has_no_interval():
    gain = compare(table({("a", "none"): 0, ("b", "estimated"): 1}, n=1))
    assert gain is not None
    assert gain.words().endswith("The estimate gains 100 points.")


@pytest.mark.parametrize("missing", ["estimated", WITHOUT])
def test_there_is_nothing_to_compare_without_both(missing):
    kept = {key: count for key, count in SOLVED.items() if key[1] not in missing}
    assert compare(table(kept)) is None


def test_the_pairs_do_not_depend_on_the_order_of_the_rows():
    trials = table(SOLVED)
    mixed = trials.sample(frac=1.0, random_state=0)
    gain, other = compare(trials), compare(mixed)
    assert gain is not None
    assert other is not None
    assert gain.points == other.points
    shown = mixed.iloc[[entry.rows[other.episode()] for entry in other.entries]]
    assert set(shown["trial"]) == {gain.episode()}


def test_the_episode_is_one_that_only_friction_solves():
    gain = compare(table(SOLVED))
    assert gain is not None
    assert gain.episode() in (6, 7)


def test_the_demo_names_the_strongest_and_draws_it(tmp_path):
    experiment = narrowed(load_experiment("demo"), trials=2)
    folder = evaluate(experiment, tmp_path, progress=False)
    said = report(folder)
    trials = pd.read_csv(folder / "trials.csv")
    gain = compare(trials)
    assert gain is not None
    assert said.splitlines()[0] == gain.words()
    page = (folder / "summary.md").read_text()
    assert gain.words() in page
    assert page.index(TRUTH) < page.index("success [%]")
    assert said.index(TRUTH) < said.index("success [%]")
    assert {entry.name for entry in gain.entries} == {
        "controller, nominal friction",
        "memory of slips",
        "recurrent network",
        "estimated friction",
        "true friction",
    }
    assert len(trials[["trial", "seed"]].drop_duplicates()) == 2
    assert str(folder / "gain.png") in said
    assert (folder / "gain.png").stat().st_size > 20_000
    assert set(trials["tolerance_mm"]) == {1.5}  # that of the level


@pytest.fixture
def two(small):
    """Two policies, one of them with true friction alone and at its own rate."""

    def make(**changes):
        alone = {"name": "constant_force", "label": "alone", "friction": ["true"], "frame_skip": 2}
        return small(policies=[{"name": "linear_slip"}, {**alone, **changes}])

    return make


def test_a_policy_acts_with_its_own_friction_choices_at_its_own_rate(two):
    experiment = two()
    pairs = {(trial.policy.title, trial.friction.source) for trial in plan(experiment)}
    assert pairs == {("linear_slip", "estimated"), ("linear_slip", "true"), ("alone", "true")}
    trials = {trial.policy.title: trial for trial in plan(experiment)}
    assert {name: environment(experiment, trial)["frame_skip"] for name, trial in trials.items()} == {
        "linear_slip": 1,
        "alone": 2,
    }
    controller: Any = make_policy(experiment, trials["linear_slip"])
    assert controller.config.physics.control_rate == 120
    assert run_trial(experiment, trials["linear_slip"]).row["steps"] == 36
    assert run_trial(experiment, trials["alone"]).row["steps"] == 18


def test_narrowing_leaves_out_policies_without_a_friction_choice(two):
    kept = narrowed(two(), friction=["estimated"])
    assert [policy.title for policy in kept.policies] == ["linear_slip"]
    assert len(narrowed(two(), friction=["true"]).policies) == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction": ["tru"]}, r"unknown friction of this experiment 'tru'; did you mean 'true'"),
        ({"friction": "true"}, r"policies\.1\.friction"),
        ({"frame_skip": 0}, r"policies\.1\.frame_skip = 0"),
        ({"name": "rotational_slip_scratch", "frame_skip": 3}, r"rotational_slip_scratch 2; asked for: 3"),
    ],
)
def test_what_is_wrong_with_a_policy_is_named(two, change, message):
    with pytest.raises(ValueError, match=message):
        two(**change)
