"""Pictures say why an estimate is off."""

from types import SimpleNamespace

import numpy as np
import pytest

import estimator
from estimator.reasons import NEEDS
from slipgym.rendering import camera, plot
from slipgym.rendering.discrepancy import Discrepancy, discrepancies
from slipgym.rendering.history import COLUMNS, History
from slipgym.rendering.text import breadth

STEP = 0.01
STEPS = 100


class Past(History):
    """An episode of one second, with mu_s exact; columns of mu_c are given."""

    def __init__(self, **columns):
        self.rows, self.step_time = np.zeros((STEPS + 1, len(COLUMNS))), STEP
        self._simulation, self._row = SimpleNamespace(episode={"step": [STEPS]}), 0
        given = {"mu_s": 0.6, "true_mu_s": 0.6, "mu_c": 0.4, "true_mu_c": 0.4, "data_mu_c": np.arange(101)}
        for name, values in {**given, **columns}.items():
            self.rows[:, COLUMNS.index(name)] = values


def simulated(mu_c, true, deviation=0.01, confidence=0.9, misfit=1.0, **finger):
    fingers = estimator.make_batch("adaptive", 2)
    values = {"mu_s": 0.6, "mu_c": mu_c, "r": 0.01, "sd_mu_s": 0.01, "sd_mu_c": deviation}
    values |= {"confidence_mu_s": 0.9, "confidence_mu_c": confidence, "events_mu_s": 3, "updates_mu_c": 50}
    for name, value in {**values, **finger}.items():
        fingers.estimates[name][1] = value
    fingers.states["misfit"][1] = misfit
    estimated = [[0.6, mu_c, 0.01, 0.9, confidence, 0.0, 0.01, deviation, 0.01, 0.0, 0.0]]
    return SimpleNamespace(
        estimator=fingers, estimated=np.array(estimated), ground_truth=np.array([[0.6, true, 0.01]])
    )


def found(past: Past, **values):
    return discrepancies(simulated(**values), 0, past)


def test_an_estimate_within_its_deviation_needs_no_words():
    assert found(Past(), mu_c=0.4, true=0.4) == []
    assert found(Past(), mu_c=0.43, true=0.4, deviation=0.06) == []
    assert found(Past(), mu_c=0.404, true=0.4, deviation=0.001) == []  # nothing that one sees


def test_a_large_error_is_named_within_its_deviation():
    (off,) = found(Past(mu_c=0.5), mu_c=0.5, true=0.4, deviation=0.2)
    assert off == ("mu_c", "25 % above the truth; states ± 50 %", "no more than it states")


def test_error_and_deviation_are_over_the_truth_both():
    (off,) = found(Past(mu_c=0.3), mu_c=0.3, true=0.4, deviation=0.09)
    assert off == (
        "mu_c",
        "25 % below the truth; states ± 22 %",
        "more than it states: errors of sensors or model",
    )


def test_a_value_without_data_says_which_motion_it_needs():
    expected = Discrepancy("mu_c", "not observed", "it needs slip with translation in it")
    assert found(Past(), mu_c=0.4, true=0.4, confidence=0.0) == [expected]


LATE = np.minimum(np.arange(STEPS + 1), 60)
JUMP = np.where(np.arange(STEPS + 1) < 80, 0.5, 0.4)


@pytest.mark.parametrize(
    ("past", "values", "reason"),
    [
        ({"data_mu_c": LATE, "true_mu_c": JUMP, "mu_c": 0.5}, {}, "friction changed; newest data 0.4 s old"),
        (
            {"data_mu_c": LATE, "mu_c": 0.9 - JUMP},
            {"misfit": 9.0},
            "residuals are 3.0 times what noise explains",
        ),
        ({"mu_c": 0.5}, {"misfit": 9.0}, "residuals are 3.0 times what noise explains"),
        ({"mu_c": 0.5}, {"deviation": 0.12}, "no more than it states"),
        ({"mu_c": 0.5, "data_mu_c": LATE - 20}, {}, "newest data 0.4 s old"),
        ({"mu_c": 0.5, "true_mu_c": JUMP}, {}, "friction changed 0.2 s ago"),
        ({"mu_c": 0.5}, {}, "more than it states: errors of sensors or model"),
    ],
)
def test_each_reason(past, values, reason, monkeypatch):
    monkeypatch.setattr("slipgym.rendering.discrepancy.RECENT", 0.35)
    off = found(Past(**past), mu_c=0.5, true=0.4, **values)
    states = 100 * values.get("deviation", 0.01) / 0.4
    assert off == [Discrepancy("mu_c", f"25 % above the truth; states ± {states:.0f} %", reason)]


def test_the_same_words_for_both_are_said_once():
    expected = Discrepancy("mu_c, mu_s", "25 % above the truth; states ± 10 %", "newest data 1.0 s old")
    past = Past(mu_c=0.5, mu_s=0.75, data_mu_c=0, data_mu_s=0)
    values = simulated(0.5, 0.4, deviation=0.04, sd_mu_s=0.06)
    values.estimated[0, [0, 6]] = 0.75, 0.06
    assert discrepancies(values, 0, past) == [expected]


def test_an_environment_says_them_where_it_draws(make):
    env = make(engine="planar", render_mode=None)
    with pytest.raises(RuntimeError, match="call reset"):
        env.discrepancies()
    env.reset(seed=0)
    assert env.discrepancies() == []  # no history is kept
    env = make(engine="planar")
    env.reset(seed=0)
    assert [off.error for off in env.discrepancies()] == ["not observed"] * 2


def test_reasons_fit_beside_the_view():
    reasons = [
        "more than it states: errors of sensors or model",
        *NEEDS.values(),
    ]
    reasons += [
        "residuals are 10.0 times what noise explains",
        "mu_s not above mu_c: both are their mean",
    ]
    assert [words for words in reasons if breadth(words, 12) > camera.STRIP - 14] == []


@pytest.mark.parametrize("confidence", [0.0, 1.0])
def test_a_picture_has_them_below_the_plots(make, changed, confidence):
    env = make(engine="planar")
    env.reset(seed=0)
    simulation = env.simulation
    simulation.estimated[0, :9] = simulation.ground_truth[0, :9]
    simulation.estimated[0, 6:9] = 1e-3
    env._renderer.begin()
    exact = env.render()
    simulation.estimated[0, 1] *= 1.3
    simulation.estimated[0, 4] = confidence
    difference = changed(exact, env.render())
    assert difference[plot._NOTES - 12 :, 448:].sum() > 300
