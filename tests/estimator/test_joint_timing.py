"""Velocities are window averages that come late; forces are instants that come at once."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE

MU_C, MU_S = 0.4, 0.6


def leaps(delay: int, seed: int = 0, count: int = 12):
    """Short slips that end while the grip closes, with the stuck contact at the largest normal force.

    The force of sample k is that of time k; the velocity is the mean over the window that closed `delay`
    samples before. Slips begin and end anywhere inside a window.
    """
    rng = np.random.default_rng(seed)
    fine = 64  # instants per window
    speed, normal, forces = [], [], []
    for _ in range(count):
        stick, slide = int(fine * rng.uniform(40, 42)), int(fine * rng.uniform(5, 7))
        speed += [0.0] * stick + [0.05] * slide
        loosening, closing = np.geomspace(12.0, 1.7, stick), np.linspace(1.7, 9.0, slide)
        normal += [*loosening, *closing]
        forces += [*np.full(stick, MU_S * 1.7), *(MU_C * closing)]
    position = np.concatenate([np.zeros(fine * delay), np.cumsum(speed) / (fine * RATE)])
    record = []
    for k in range(1, len(speed) // fine):
        v = (position[fine * k] - position[fine * (k - 1)]) * RATE
        record.append((k / RATE, (forces[fine * k], 0.0, normal[fine * k], 0.0), (v, 0.0, 0.0)))
    return record


def final(name, record, **parameters):
    est = estimator.make(name, **parameters)
    for sample in record:
        est.update(*sample)
    return est.estimate


@pytest.mark.parametrize("delay", [0, 1, 2, 6])
def test_only_instants_of_sliding_are_learnt(delay):
    e = final("joint", leaps(delay), velocity_delay=delay)
    assert e.mu_c == pytest.approx(MU_C, rel=1e-3)
    assert e.updates_mu_c >= 12 * 3


def test_the_plain_estimator_takes_stuck_samples_for_sliding():
    """Why: in the same record "rls" without its heuristic reads mu_c far too low."""
    assert final("rls", leaps(1), heuristic=False).mu_c < 0.7 * MU_C


def test_a_wrong_delay_is_no_alignment():
    assert abs(final("joint", leaps(1), velocity_delay=0).mu_c / MU_C - 1.0) > 0.1


def test_mu_s_comes_from_the_stick_before_a_slip():
    """Up to one sample of the ramp before the break-away, 5 %, is not seen: half of it on average."""
    e = final("joint", leaps(1))
    assert e.events_mu_s >= 10
    assert MU_S * 0.93 < e.mu_s <= MU_S
    assert 0.0 < e.sd_mu_s < 0.05 * MU_S


def test_a_lost_sample_is_not_bridged():
    """After a gap the two windows are not neighbours: learning waits for four samples in a row."""
    est = estimator.make("joint")
    sample = (0.4 * 5.0, 0.0, 5.0, 0.0), (0.02, 0.0, 0.0)
    learnt = [est.update(k / RATE, *sample).observable_mu_c for k in [*range(10), *range(11, 20)]]
    assert learnt == [False] * 3 + [True] * 7 + [False] * 3 + [True] * 6


def test_loss_of_contact_starts_the_row_afresh():
    est = estimator.make("joint")
    twist = (0.02, 0.0, 0.0)
    forces = [5.0] * 6 + [0.1] + [5.0] * 5
    learnt = [
        est.update(k / RATE, (0.4 * f_n, 0.0, f_n, 0.0), twist).observable_mu_c
        for k, f_n in enumerate(forces)
    ]
    assert learnt == [False] * 3 + [True] * 3 + [False] * 4 + [True] * 2


def test_the_heuristic_can_halt_it_too():
    est = estimator.make("joint", heuristic=True)
    forces = [5.0] * 8 + [7.0] * 10
    states = [
        est.update(k / RATE, (0.4 * f_n, 0.0, f_n, 0.0), (0.02, 0.0, 0.0)) for k, f_n in enumerate(forces)
    ]
    assert [k for k, e in enumerate(states) if e.halted] == [8, 9, 10, 11, 12, 13]
    assert not any(e.observable_mu_c for e in states if e.halted)


def test_a_translation_that_breaks_off_counts_for_little():
    """The object spins on while its translation stops within a window: no instant has the mean velocity.

    The wrench is the ellipsoid's of the instant; the normal force is largest at the end of each slide. Taken
    at face value the mean puts gamma_t far above what it is, and mu_c ends at half its value.
    """
    r, omega, fine = 0.01, 0.8, 64
    slide = np.concatenate([np.linspace(0.005, 0.065, 4 * fine), np.full(fine // 2, 0.065)])
    speed = np.tile(np.concatenate([slide, np.full(5 * fine + fine // 2, 0.0012)]), 20)
    normal = np.tile(np.concatenate([np.linspace(2.0, 9.0, len(slide)), np.linspace(9.0, 2.0, 352)]), 20)
    position = np.concatenate([np.zeros(fine), np.cumsum(speed) / (fine * RATE)])
    record = []
    for k in range(1, len(speed) // fine):
        v, f_n = (position[fine * k] - position[fine * (k - 1)]) * RATE, normal[fine * k]
        scaled = np.array([speed[fine * k], r * omega])
        f_t, rim = MU_C * f_n * scaled / np.linalg.norm(scaled)
        record.append((k / RATE, (f_t, 0.0, f_n, r * rim), (v, 0.0, omega)))
    e = final("joint", record)
    assert e.mu_c == pytest.approx(MU_C, rel=0.05)
