"""Checks the estimators on exact data of an ellipsoid or a disc at 5 N."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import estimator
from slipgym.validation.figure import Figure
from slipgym.validation.records import RATE, Phase, Sample, counted, disc, ellipsoid, planar, run

BOUND = 0.5  # [%]
LENGTH = round(3.0 * RATE)  # samples of each kind of slip
MU_C, R = 0.4, 0.010
# Mean of a slow phase's counts: one in about two windows, so that single empty windows occur while it slides
SLOW, FAST = 0.5e-3, 0.02  # [m/s]


def errors(
    record: list[Sample], mu_c: float = MU_C, r: float = R, name: str = "rls", **parameters: float
) -> tuple[float, float]:
    """Errors of mu_c and r after a record [%]."""
    last = run(estimator.make(name, **parameters), record)[-1]
    return 100.0 * abs(last.mu_c / mu_c - 1.0), 100.0 * abs(last.r / r - 1.0)


def miscounted_events() -> int:
    """Starts and stops of slip in a counted record that are missed or reported twice."""
    phases = [Phase(120, 0.0, (1.0, 2.7)), Phase(60, FAST, (2.0, 2.0)), Phase(120, SLOW, (2.0, 2.0))] * 5
    record, _ = counted([*phases, Phase(120, 0.0, (2.0, 2.0))])
    slipping = [False, *(estimate.slipping for estimate in run(estimator.make("rls"), record))]
    changes = sum(a != b for a, b in pairwise(slipping))
    return abs(changes - 2 * 5)


def estimation() -> Iterator[Figure]:
    """Convergence within 3 s of slip, and the events of a record with counted velocities."""
    translation = ellipsoid(LENGTH, 0.02, 0.0, MU_C, R)
    yield Figure("rls, translation: mu_c", BOUND, errors(translation)[0], "%")
    spin = ellipsoid(LENGTH, 0.0, 2.0, MU_C, R, start=1 + LENGTH)
    yield Figure("rls, translation, then spin: r", BOUND, errors(translation + spin)[1], "%")
    for gamma_t in (0.5, 0.7, 0.9):
        mu_c, r = errors(ellipsoid(LENGTH, *planar(gamma_t, R), MU_C, R))
        yield Figure(f"rls, planar at gamma_t {gamma_t}: mu_c", BOUND, mu_c, "%")
        yield Figure(f"rls, planar at gamma_t {gamma_t}: r", BOUND, r, "%")
    before = ellipsoid(LENGTH, *planar(0.7, R), MU_C, R)
    after = ellipsoid(LENGTH, *planar(0.7, 0.8 * R), 1.5 * MU_C, 0.8 * R, start=1 + LENGTH)
    mu_c, r = errors(before + after, 1.5 * MU_C, 0.8 * R)
    yield Figure("rls, planar, after a change: mu_c", BOUND, mu_c, "%")
    yield Figure("rls, planar, after a change: r", BOUND, r, "%")
    yield Figure("rls, 5 starts and 5 stops, counted: missed or twice", 0.0, miscounted_events(), "")
    yield from joint()


def joint() -> Iterator[Figure]:
    """The worst of "joint" and "disc" after spin alone, over normal forces and starts that lock "rls" out."""
    for name, surface in (("joint", ellipsoid), ("disc", disc)):
        worst = [0.0, 0.0]
        for f_n in (2.0, 5.0, 20.0):
            spin = surface(LENGTH, 0.0, 2.0, MU_C, R, f_n)
            for gamma_t in (0.1, 0.5, 0.9, 0.95):
                slip = surface(LENGTH, *planar(gamma_t, R), MU_C, R, f_n, start=1 + LENGTH)
                for r0 in (0.001, 0.1):
                    found = errors(spin + slip, name=name, r0=r0, r_max=0.1)
                    worst = [max(pair) for pair in zip(worst, found, strict=True)]
        yield Figure(f"{name}, spin, then planar, worst of 24: mu_c", BOUND, worst[0], "%")
        yield Figure(f"{name}, spin, then planar, worst of 24: r", BOUND, worst[1], "%")
