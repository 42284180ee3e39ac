"""Why an estimate has little confidence, in a sentence."""

import pytest

import estimator

SURE = {"mu_s": 0.5, "mu_c": 0.4, "r": 0.01, "sd_mu_s": 0.01, "sd_mu_c": 0.01, "sd_r": 2e-4}
SURE |= {f"confidence_{name}": 0.9 for name in ("mu_s", "mu_c", "r")}
SURE |= {"events_mu_s": 3, "updates_mu_c": 40, "updates_r": 40}


def estimated(**values):
    return estimator.make("rls").estimate._replace(**{**SURE, **values})


CASES = {
    "start value": (
        {"confidence_r": 0.0, "updates_r": 0},
        {"r": "not observed: this is the start value; it needs slip with rotation in it"},
    ),
    "deviation": (
        {"confidence_mu_c": 0.2, "sd_mu_c": 0.08},
        {"mu_c": "one standard deviation is 20 %: be cautious; it needs slip with translation in it"},
    ),
    "few data": (
        {"confidence_mu_c": 0.3, "updates_mu_c": 7},
        {"mu_c": "little data (7): be cautious; it needs slip with translation in it"},
    ),
    "contradiction": (
        {"confidence_mu_s": 0.4, "mu_s": 0.4},
        {
            "mu_s": "mu_s not above mu_c: both are their mean: be cautious; "
            "it needs slips that start or stop in contact"
        },
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_each_reason_is_named(case):
    values, expected = CASES[case]
    assert estimator.reasons(estimated(**values)) == expected


def test_a_sure_estimate_needs_no_reason():
    assert estimator.reasons(estimated(), misfit=9.0) == {}


def test_residuals_are_a_reason_and_an_estimator_knows_its_own():
    words = "one standard deviation is 20 %, residuals are 3.0 times what noise explains: be cautious"
    found = estimator.reasons(estimated(confidence_r=0.2, sd_r=2e-3), misfit=9.0)
    assert found == {"r": f"{words}; it needs slip with rotation in it"}
    finger = estimator.make("adaptive")
    assert set(finger.reasons()) == {"mu_s", "mu_c", "r"}
    states, estimates = finger.batch.states, finger.batch.estimates
    states["misfit"], estimates["updates_r"], estimates["sd_r"] = 9.0, 5, 0.2 * estimates["r"]
    assert finger.reasons()["r"] == found["r"]
    assert estimator.make("rls").reasons()["r"].startswith("not observed")


def test_an_r_beyond_the_pad_is_a_reason():
    words = "one standard deviation is 80 %, the slips ask for an r beyond its bounds"
    found = estimator.reasons(estimated(confidence_r=0.02, sd_r=8e-3), at_bound=1.0)
    assert found["r"].startswith(words)
    finger = estimator.make("adaptive")
    finger.batch.states["at_bound"], finger.batch.estimates["updates_r"] = 0.9, 5
    assert "beyond its bounds" in finger.reasons()["r"]
