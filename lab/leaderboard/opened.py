"""Makes a scenario that begins with the gripper open: zero errors may be seen before the first contact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from policies.leaderboard.imperfect import AT_ONCE
from policies.leaderboard.imperfections import Imperfections, impaired
from policies.leaderboard.scenario import FIELDS, Run, Scenario, after
from policies.leaderboard.scenarios import Effort, patch, turning
from slipgym.synthetic import Record, sense

OPEN = 60
"""Readings of the open gripper."""
NOISE = (0.02, 0.02, 0.04, 5e-4)
"""Noise of f_x, f_y, f_n [N] and tau [N m], that of the realistic sensors."""


def opened(effort: Effort) -> Iterator[Scenario]:
    """Zero errors after half a second of the open gripper, in which they may be seen; not in the ranking."""
    exact = sense(patch(turning(3.0), effort.cells), effort.seeds, effort.seed, config=AT_ONCE)
    before = unloaded_first(exact, OPEN, effort.seed)
    late = after(before, before.t[-1] - 0.25)
    zero = Imperfections(velocity_delay=1, zero=0.2, zero_normal=0.2)
    record = impaired(before, zero, effort.seed)
    yield Scenario("open gripper", "zero 0.2 N", (Run(record, {"mu_c": late, "r": late}),))


def unloaded_first(record: Record, samples: int, seed: int) -> Record:
    """A record with readings of the noise alone, at rest, before its first sample.

    Args:
        record: m fingers, n samples.
        samples: How many [-].
        seed: Of the noise.
    """
    m = len(record.wrenches)
    noise = np.random.default_rng(seed).standard_normal((m, samples, 4)) * list(NOISE)
    period, phase = record.t[1] - record.t[0], np.repeat(record.phase[:1], samples)
    return Record(
        t=np.concatenate((record.t[0] + period * np.arange(samples), record.t + period * samples)),
        wrenches=np.concatenate((noise, record.wrenches), axis=1),
        twists=np.concatenate((np.zeros((m, samples, 3)), record.twists), axis=1),
        phase=np.concatenate((phase, record.phase)),
        **{name: np.pad(getattr(record, name), (samples, 0), mode="edge") for name in FIELDS},
    )
