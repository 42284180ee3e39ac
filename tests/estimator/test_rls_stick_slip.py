"""Algorithm 1 on synthetic records whose velocity is counted, as the optical sensor's is."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import COUNT, RATE, Phase, counted, ellipsoid, run

F_N, MU_S, MU_C = 5.0, 0.6, 0.4
STICK = Phase(60, 0.0, (0.3 * F_N, MU_S * F_N))
RAMP_STEP = (MU_S - 0.3) / (STICK.samples - 1)
"""What f_t / f_n gains in one sample of STICK."""


def slip(samples: int, speed: float) -> Phase:
    return Phase(samples, speed, (MU_C * F_N, MU_C * F_N))


def transitions(estimates: list[estimator.Estimate]) -> tuple[list[int], list[int]]:
    state = np.array([False] + [e.slipping for e in estimates])
    change = np.diff(state.astype(int))
    return np.flatnonzero(change == 1).tolist(), np.flatnonzero(change == -1).tolist()


def slow_phases(slow: float) -> list[Phase]:
    return [
        STICK,
        slip(40, 0.01),
        slip(60, slow),
        slip(40, 0.01),
        STICK,
        slip(40, 0.003),
        slip(60, slow),
        STICK,
    ]


# Three empty windows in a row make a stop: slip reads as slip from one count in three windows, 0.32 mm/s, on.
@pytest.mark.parametrize("slow", [0.35e-3, 0.6e-3, 0.9e-3])
def test_every_start_and_stop_is_found_once(slow):
    assert slow > COUNT * RATE / 3
    record, begin = counted(slow_phases(slow), F_N)
    starts, stops = transitions(run(estimator.make("rls"), record))
    true_starts, true_stops = [begin[1], begin[5]], [begin[4], begin[7]]
    assert len(starts) == len(stops) == 2
    for found, true in zip(starts, true_starts, strict=True):
        assert 0 <= found - true <= 1  # the first window may hold a count less than eps_v needs
    for found, true in zip(stops, true_stops, strict=True):
        assert 0 <= found - true <= 2  # three empty windows; at most two came before the true stop


@pytest.mark.parametrize("slow", [0.35e-3, 0.6e-3, 0.9e-3])
def test_a_single_empty_window_as_stop_finds_slips_that_were_none(slow):
    """As published (one sample of v == 0): the slow phase in the middle splits the first slip."""
    record, _ = counted(slow_phases(slow), F_N)
    starts, _ = transitions(run(estimator.make("rls", stick_samples=1, stick_band=0.0), record))
    assert len(starts) > 2


def test_slower_than_one_count_in_three_windows_reads_as_a_stop():
    record, _ = counted(slow_phases(0.2e-3), F_N)
    starts, _ = transitions(run(estimator.make("rls"), record))
    assert len(starts) == 3


def test_mu_s_is_the_mean_of_the_largest_ratios():
    record, begin = counted([STICK, slip(40, 0.01), STICK, slip(40, 0.01), STICK], F_N)
    estimates = run(estimator.make("rls"), record)
    starts, stops = transitions(estimates)
    assert starts == [begin[1], begin[3]]
    for start in starts:  # the last two stick samples: half a ramp step below the break-away
        assert estimates[start].mu_s == pytest.approx(MU_S - RAMP_STEP / 2, rel=1e-12)
    for stop in stops:  # what the slip showed
        assert estimates[stop].mu_s == pytest.approx(max(MU_C, estimates[stop].mu_c), rel=1e-12)
    assert estimates[0].mu_s == 1.5
    counts = [estimates[i].events_mu_s for i in sorted(starts + stops)]
    assert counts == [1, 2, 3, 4]
    assert [estimates[i].confidence_mu_s for i in sorted(starts + stops)] == [1 / 2, 2 / 3, 3 / 4, 4 / 5]


@pytest.mark.parametrize(("n_a", "n_b"), [(1, 16), (2, 16), (5, 16), (5, 5), (20, 64)])
def test_buffer_lengths(n_a, n_b):
    record, begin = counted([Phase(64, 0.0, (0.5, 2.5)), slip(5, 0.01)], F_N)
    ratios = np.array([sample[1][0] / F_N for sample in record[: begin[1] + 1]])
    expected = np.mean(np.sort(ratios[-n_b:])[-n_a:])
    estimates = run(estimator.make("rls", n_a=n_a, n_b=n_b), record)
    assert estimates[begin[1]].mu_s == pytest.approx(expected, rel=1e-12)


def test_an_event_with_too_few_samples_leaves_mu_s():
    """A finger that closes on a moving object has no stick behind it: mu_s cannot come from that."""
    estimates = run(estimator.make("rls"), ellipsoid(5, 0.02, 0.0, MU_C, 0.01))
    assert estimates[0].slipping
    assert estimates[-1].events_mu_s == 0
    assert estimates[-1].mu_s == 1.5


def spin_between_stick() -> list[tuple]:
    """Loaded stick, half a second of pure spin, loaded stick."""
    stick = [(0.0, (1.0, 0.0, F_N, 0.0), (0.0, 0.0, 0.0))] * 30
    spin = [sample[1:] for sample in ellipsoid(60, 0.0, 2.0, MU_C, 0.01)]
    samples = [s[1:] for s in stick] + spin + [s[1:] for s in stick]
    return [((k + 1) / RATE, *sample) for k, sample in enumerate(samples)]


def test_the_machine_follows_spin():
    starts, stops = transitions(run(estimator.make("rls"), spin_between_stick()))
    assert (starts, stops) == ([30], [92])  # the third sample at rest


def test_the_gated_machine_sleeps_through_spin():
    starts, _ = transitions(run(estimator.make("rls", machine_gated=True), spin_between_stick()))
    assert starts == []


def test_a_stop_under_torque_alone():
    """At rest under a torque gamma_t is 0: the machine sees the stop, the gated one does not."""
    slide = ellipsoid(30, 0.02, 0.0, MU_C, 0.01)
    rest = [((31 + k) / RATE, (0.0, 0.0, F_N, 0.01), (0.0, 0.0, 0.0)) for k in range(10)]
    assert not run(estimator.make("rls"), slide + rest)[-1].slipping
    assert run(estimator.make("rls", machine_gated=True), slide + rest)[-1].slipping


def test_below_eps_v_gamma_comes_from_the_force():
    """A stray count of 1 mm/s in rotation says nothing about a contact that carries force only."""
    sample = (1 / RATE, (1.0, 0.0, F_N, 0.0), (0.0, 0.0, 1e-3 / 0.02))
    careful = estimator.make("rls").update(*sample)
    published = estimator.make("rls", low_speed_gamma_from_force=False).update(*sample)
    assert (careful.gamma_t, careful.gamma_tau) == (1.0, 0.0)
    assert (published.gamma_t, published.gamma_tau) == (0.0, 1.0)


def test_gamma_from_force_divides_the_torque_by_r():
    """f_t = 3 N and tau / r = 4 N with r = 0.02 m: the cosines are 0.6 and 0.8."""
    e = estimator.make("rls").update(0.0, (3.0, 0.0, 20.0, 4.0 * 0.02), (0.0, 0.0, 0.0))
    assert (e.gamma_t, e.gamma_tau) == (pytest.approx(0.6), pytest.approx(0.8))
