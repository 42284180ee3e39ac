"""Trials in a vector environment are those of single environments."""

import numpy as np
import pytest

from policies.evaluation.plan import ROWS, pieces, plan
from policies.evaluation.trial import run_trial, run_trials


def planar(small, **changes):
    return small(
        engine="planar",
        randomization="train",
        materials=["wood", "random"],
        policies=[{"name": "linear_slip"}, {"name": "constant_force", "parameters": {"force": 3.0}}],
        **changes,
    )


def test_rows_are_single_environments_bit_for_bit(small):
    experiment = planar(small, frame_skip=2)
    trials = plan(experiment)
    together = run_trials(experiment, trials, progress=False)
    alone = [run_trial(experiment, trial) for trial in trials]
    assert len({result.row["steps"] for result in together}) >= 1
    for one, other in zip(together, alone, strict=True):
        assert one.row == other.row
        assert (one.series is None) == (other.series is None)
        for name, values in (one.series or {}).items():
            np.testing.assert_array_equal(values, (other.series or {})[name])


def test_a_block_has_one_policy_one_friction_choice_and_few_rows(small):
    experiment = planar(small, trials=ROWS // 3)
    trials = plan(experiment)
    found = pieces(experiment, trials)
    assert [trial for block in found for trial in block] == trials
    for block in found:
        assert len(block) <= ROWS
        assert len({(trial.policy.title, trial.friction.title) for trial in block}) == 1


def test_an_error_in_a_row_names_the_trial(small):
    experiment = planar(small, options={"object_mass": 0.2})
    broken = experiment.model_copy(
        update={"policies": (experiment.policies[1].model_copy(update={"parameters": {"force": 99.0}}),)}
    )
    with pytest.raises(ValueError, match="force = 99") as caught:
        run_trials(broken, plan(broken), progress=False)
    assert "in trial" in "".join(caught.value.__notes__)
