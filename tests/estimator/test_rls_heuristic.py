"""The halt on a fast rise of the normal force, and the loss of contact."""

import pytest

import estimator
from tests.estimator.exact_records import RATE, ellipsoid, run

MU_C, R = 0.4, 0.01
FAST, SLOW = 1.3, 1.2
"""Rises of f_n per sample [N]: 156 and 144 N/s, either side of eps_delta = 150 N/s."""


def normal_forces(est, forces, times=None):
    """Translating slip with the given normal force per sample."""
    times = [(k + 1) / RATE for k in range(len(forces))] if times is None else times
    return [
        est.update(t, (MU_C * f_n, 0.0, f_n, 0.0), (0.02, 0.0, 0.0))
        for t, f_n in zip(times, forces, strict=True)
    ]


def halted(estimates):
    return [k for k, e in enumerate(estimates) if e.halted]


# Far from t = 0 the sampling times carry rounding of 1e-11 s; a halt is six samples long all the same.
@pytest.mark.parametrize("origin", [0.0, 1e5])
def test_a_halt_lasts_six_samples(origin):
    times = [origin + k / RATE for k in range(20)]
    estimates = normal_forces(estimator.make("rls"), [5.0] * 4 + [5.0 + FAST] * 16, times)
    assert halted(estimates) == [4, 5, 6, 7, 8, 9]
    updates = [e.updates_mu_c for e in estimates]
    assert updates == [1, 2, 3, 4, 4, 4, 4, 4, 4, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]


def test_a_new_rise_starts_the_halt_afresh():
    forces = [5.0] * 4 + [5.0 + FAST] * 3 + [5.0 + 2 * FAST] * 13
    assert halted(normal_forces(estimator.make("rls"), forces)) == list(range(4, 13))


def test_halt_duration_in_samples():
    est = estimator.make("rls", halt_duration=0.1)
    assert halted(normal_forces(est, [5.0] * 4 + [5.0 + FAST] * 20)) == list(range(4, 16))


@pytest.mark.parametrize("after", [5.0 + SLOW, 5.0 - FAST, 0.5])
def test_slow_rises_and_falls_do_not_halt(after):
    assert halted(normal_forces(estimator.make("rls"), [5.0] * 4 + [after] * 8)) == []


def test_the_rate_is_over_the_true_elapsed_time():
    """With a sample lost, the same rise takes two intervals: 78 N/s."""
    times = [k / RATE for k in (1, 2, 3, 5, 6, 7)]
    assert halted(normal_forces(estimator.make("rls"), [5.0] * 3 + [5.0 + FAST] * 3, times)) == []


def test_the_plain_estimator_never_halts():
    est = estimator.make("rls", heuristic=False)
    assert halted(normal_forces(est, [5.0] * 4 + [15.0] * 8)) == []


def test_the_machine_runs_while_halted_but_nothing_is_learnt():
    est = estimator.make("rls")
    for k in range(10):
        est.update(k / RATE, (1.0, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))
    before = est.estimate
    e = est.update(10 / RATE, (3.0, 0.0, 7.0, 0.0), (0.02, 0.0, 0.0))
    assert e.halted
    assert e.slipping
    assert e[:3] == before[:3]
    assert e.events_mu_s == 0
    assert est.batch.states["buffer_size"][0] == 0  # the stick before the slip is not kept for the next event


def test_halted_samples_stay_out_of_the_buffer():
    """Ratios 0.2 in stick, 0.6 while halted, 0.4 in the first slip sample: mu_s is 0.4 and 0.2 averaged."""
    est = estimator.make("rls")
    stick = [(0.2 * 5.0, 5.0, 0.0)] * 10
    halt = [(0.6 * 8.0, 8.0, 0.0)] * 6
    for k, (f_t, f_n, v_x) in enumerate([*stick, *halt, (0.4 * 8.0, 8.0, 0.02)]):
        est.update(k / RATE, (f_t, 0.0, f_n, 0.0), (v_x, 0.0, 0.0))
    assert est.estimate.slipping
    assert not est.estimate.halted
    assert est.batch.states["mu_s"] == pytest.approx(0.3)
    assert est.estimate.mu_s == est.estimate.mu_c > 0.3


def test_the_heuristic_keeps_stuck_samples_out():
    """The grip closes on a slip; the late velocity still reads motion for four stuck samples.

    Those carry the slip's force, 2 N, at 15 N: in the plain estimator they pull mu_c towards 0.13.
    """
    slip = [(2.0, 5.0)] * 60
    stuck = [(2.0, 15.0)] * 4
    results = {}
    for heuristic in (True, False):
        est = estimator.make("rls", heuristic=heuristic)
        for k, (f_t, f_n) in enumerate(slip + stuck):
            est.update(k / RATE, (f_t, 0.0, f_n, 0.0), (0.02, 0.0, 0.0))
        results[heuristic] = est.estimate.mu_c
    assert results[True] == pytest.approx(0.4, rel=5e-3)
    # Weighted least squares: sum(w f_t f_n) / sum(w f_n^2), w = 0.98^age, gives 0.26.
    assert results[False] < 0.3


def test_loss_of_contact_ends_the_halt_and_empties_the_buffer():
    est = estimator.make("rls")
    normal_forces(est, [5.0, 5.0, 5.0 + FAST])
    lost = est.update(4 / RATE, (0.0, 0.0, 0.19, 0.0), (0.02, 0.0, 0.0))
    state = est.batch.states[0]
    assert (lost.halted, lost.slipping, lost.gamma_t) == (False, False, 0.0)
    assert (state["buffer_size"], state["halt_left"], state["still_samples"]) == (0, 0.0, 0)
    again = est.update(5 / RATE, (0.08, 0.0, 0.2, 0.0), (0.02, 0.0, 0.0))
    assert again.updates_mu_c == lost.updates_mu_c + 1


def test_nothing_is_learnt_out_of_contact():
    est = estimator.make("rls")
    start = est.estimate
    assert set(run(est, ellipsoid(50, 0.02, 1.0, MU_C, R, f_n=0.19))) == {start}
