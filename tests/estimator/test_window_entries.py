"""The window of "adaptive": its entries at any rate, its memory, its changes of friction."""

import numpy as np
import pytest

import estimator
from estimator.window.layout import EMPTY, ENTRIES, SLIDE
from estimator.window.window import new_entry
from tests.estimator.rigid_slips import FINE, Pad, Phase, Sensors, contact, planar, sense, steps

PAD, F_N = Pad(0.4, 0.006), 6.0
OPEN, REST = Phase(0.4, 0.0), Phase(0.3, F_N)


def fresh():
    return estimator.make_batch("adaptive", 1).states.view(np.recarray)[0]


def test_the_oldest_entry_makes_room():
    state = fresh()
    for k in range(ENTRIES + 5):
        state.slip_time = 0.1 * k
        new_entry(state, SLIDE, 1.0, 0.0, np.array([1.0, 0.0, 3.0, 0.0]))
    assert sorted(state.entries["end"]) == pytest.approx(0.1 * np.arange(5, ENTRIES + 5))


def played(phases, rate=120, fingers=1, sensors=None):
    """Batch after the records of these phases, and whether a change was ever found in each finger."""
    motion = contact(phases, PAD)
    at = steps(motion, rate)
    records = [sense(motion, at, sensors or Sensors(), seed) for seed in range(fingers)]
    wrenches, twists = (np.ascontiguousarray(np.stack(part, axis=1)) for part in zip(*records, strict=True))
    batch, changed = estimator.make_batch("adaptive", fingers), np.zeros(fingers, bool)
    for k, t in enumerate((at / FINE).tolist()):
        batch.update(t, wrenches[k], twists[k])
        changed |= batch.states["changed"] > 0.0
    return batch, changed


def test_entries_are_the_same_at_any_rate():
    """Rates of which 8.3 ms are a whole number of samples: as many entries with the same twists.

    The wrench of an interval is the mean of its samples, so half an interval of twelve may be off at an end.
    """
    slips = [Phase(0.45, F_N, planar(PAD, gamma_t, angle)) for gamma_t, angle in ((0.9, 0.4), (0.6, 2.5))]
    phases, found = [OPEN, *(part for slip in slips for part in (REST, slip)), REST], []
    for rate in (120, 240, 600):
        entries = played(phases, rate, sensors=Sensors(noise=0.0))[0].states["entries"][0]
        kept = entries[(entries["kind"] == SLIDE) & (entries["time"] > 0.09)]
        found.append((np.sum(entries["kind"] != EMPTY), kept["motion"].copy(), kept["wrench"].copy()))
    for count, motion, wrench in found[1:]:
        assert abs(count - found[0][0]) <= 1  # a stretch of some milliseconds more at an end
        np.testing.assert_allclose(motion[-1], found[0][1][-1], rtol=0.01, atol=2e-4)
        np.testing.assert_allclose(wrench[-1], found[0][2][-1], rtol=0.042)


def test_constant_friction_is_rarely_a_change():
    """Twenty slips in all directions, with and without spin, 300 fingers: below 2 % of the runs."""
    slips = [Phase(0.3, F_N, planar(PAD, (1.0, 0.8, 0.5)[k % 3], 2.4 * k)) for k in range(20)]
    _, changed = played([OPEN, *(part for slip in slips for part in (REST, slip))], fingers=300)
    assert changed.mean() < 0.02


@pytest.mark.parametrize("factor", [0.7, 1.4])
def test_a_change_of_friction_is_found(factor):
    slips = [Phase(0.6, F_N, planar(PAD, 0.8, 2.4 * k), factor=1.0 if k < 3 else factor) for k in range(5)]
    batch, changed = played([OPEN, *(part for slip in slips for part in (REST, slip))], fingers=20)
    assert changed.all()
    np.testing.assert_allclose(batch.estimates["mu_c"], factor * PAD.mu_c, rtol=0.06)
