"""The spring of a pad: the compliance that is possible, and what that makes of a motion."""

import numpy as np
import pytest

import estimator
from estimator.window.layout import MU, R
from estimator.window.spring import is_no_spring

P = estimator.AdaptiveParameters().as_array().view(np.recarray)[0]
RATE, COMPLIANCE = 120, 1.5e-4


def bound(late):
    """The largest compliance that is possible, after loads of 1 to 2 N whose springs are shown late."""
    batch = estimator.make_batch("adaptive", 1)
    rest, rise = np.full(40, 1.0), np.linspace(1.0, 2.0, 4)
    load = np.concatenate([rest, rise, np.full(40, 2.0), rise[::-1]] * 3)
    travel = np.concatenate([np.full(late, load[0]), load])[: len(load)] * COMPLIANCE
    speed = np.diff(travel, prepend=travel[0]) * RATE
    for k in range(len(load)):
        batch.update(k / RATE, np.array([[load[k], 0.0, 8.0, 0.0]]), np.array([[speed[k], 0.0, 0.0]]))
    return batch.states["spring"][0]


@pytest.mark.parametrize("late", [0, 1, 4, 7])
def test_a_spring_that_is_seen_late_is_no_stiff_pad(late):
    """The sensor sleeps at rest: of a change of the load nothing is seen for up to 40 ms and a latency."""
    assert bound(late) >= COMPLIANCE


def test_an_object_that_does_not_move_is_on_a_hard_pad():
    batch = estimator.make_batch("adaptive", 1)
    for k in range(120):
        load = 1.0 + 1.5 * (1.0 + np.sin(2.0 * np.pi * 3.0 * k / RATE))
        batch.update(k / RATE, np.array([[load, 0.0, 8.0, 0.0]]), np.zeros((1, 3)))
    assert batch.states["spring"][0] <= P.compliance


@pytest.mark.parametrize("r", [0.004, 0.006])
def test_a_small_pad_springs_further_in_torsion(r):
    """A turn of tau / (k r^2) on a pad of the compliance that is assumed is hardly a slip, whatever its r."""
    state = estimator.make_batch("adaptive", 1).states.view(np.recarray)[0]
    state.interval, state.stretch["instants"], rim = 8, 4.0, 0.5 * P.r_max
    state.x[R], state.covariance[R, R], state.covariance[MU, MU] = np.log(r), 0.01, 0.01
    torque = np.linspace(0.0, 0.02, 8)
    state.intervals["wrench"][:8, 3] = torque
    turn = torque[-1] * state.spring / r**2
    assert is_no_spring(state, P, rim * turn) < 0.25
    assert is_no_spring(state, P, 6.0 * rim * turn) > 0.9
