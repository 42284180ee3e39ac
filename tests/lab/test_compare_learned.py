"""Learned policies and controllers in the same episodes."""

import numpy as np
import pandas as pd
import pytest

from lab import compare_learned


def table(true, estimated, none):
    """Trials of learned policies with these rewards; solved where they are positive."""
    columns = {"true": true, "estimated": estimated, "none": none}
    rows = [
        {
            "policy": compare_learned.LEARNED,
            "friction": source,
            "options": "",
            "trial": k,
            "success": reward > 0.0,
            "dropped": False,
            "return": reward,
            "mean_force_N": 5.0,
        }
        for source, rewards in columns.items()
        for k, reward in enumerate(rewards)
    ]
    return pd.DataFrame(rows)


def test_the_share_is_of_what_the_truth_is_worth():
    none = np.arange(20.0) - 9.5
    found = compare_learned.benefit(table(none + 10.0 + 0.1 * np.sin(none), none + 5.0, none)).set_index(
        "measure"
    )
    assert found.loc["sum of rewards", "share [%]"] == "50"
    assert found.loc["sum of rewards", "estimated - none"] == "5.0 (5.0 to 5.0)"


def test_there_is_no_share_of_nothing():
    none = np.arange(20.0) - 9.5
    found = compare_learned.benefit(table(none + np.cos(9.0 * none), none + 5.0, none)).set_index("measure")
    assert found.loc["sum of rewards", "share [%]"] == "-"


def test_gains_are_those_of_the_same_episodes_and_the_same_friction():
    learned = table([3.0, 5.0], [2.0, 4.0], [9.0, 9.0])
    controller = table([1.0, 3.0], [2.5, 4.5], [0.0, 0.0])
    controller = controller[controller["friction"] != "none"].assign(policy=compare_learned.CONTROLLER)
    found = compare_learned.gains(pd.concat([learned, controller])).set_index("learned - controller")
    assert list(found.columns) == ["estimated", "true"]
    assert found.loc["sum of rewards", "true"] == "2.0 (2.0 to 2.0)"
    assert found.loc["sum of rewards", "estimated"] == "-0.5 (-0.5 to -0.5)"
    assert found.loc["success [%]", "estimated"] == "0.0 (0.0 to 0.0)"


def test_outcomes_have_a_row_for_each_source():
    found = compare_learned.outcomes(table([1.0, 2.0], [1.0, -2.0], [-1.0, -1.0])).set_index("friction")
    assert [text.split()[0] for text in found["success [%]"]] == ["100.0", "50.0", "0.0"]
    assert list(found["grip force [N]"]) == ["5.0 (5.0 to 5.0)"] * 3


@pytest.mark.slow
def test_the_controller_runs_in_the_experiments_episodes():
    trials = compare_learned.trials_of("hold", 2, "planar", progress=False)
    controller = trials[trials["policy"] == compare_learned.CONTROLLER]
    assert list(controller["friction"]) == ["estimated", "estimated", "true", "true"]
    assert list(controller["seed"])[:2] == list(controller["seed"])[2:]
    with pytest.raises(ValueError, match="hole"):
        compare_learned.trials_of("hole")


def test_a_task_without_learned_policies_is_named_with_those_that_have():
    tasks = compare_learned.learned_tasks()
    assert tasks == ["linear_slip", "rotational_slip", "hinge", "planar_slip", "hold"]
    with pytest.raises(
        ValueError, match=r"carry has no learned policies; tasks that have: linear_slip, .*hold"
    ):
        compare_learned.trials_of("carry", 2)


def test_without_all_sources_there_is_no_share():
    some = table([1.0, 2.0], [1.0, 2.0], [1.0, 2.0])
    assert compare_learned.benefit(some[some["friction"] != "true"]).empty
