"""Warns about readings that look like faults of a sensor: saturated, frozen, twice the same, in another unit.

Each rule compares a channel with itself, so that coarse counts, sampled and held values, and velocities
that are zero in stick pass.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from estimator.online import TWIST, WRENCH
from estimator.records.alignment import Samples, period
from estimator.records.checks import USUAL_LEVER, USUAL_SPEED
from estimator.records.record import Array, Record, seconds
from estimator.records.units import likely_unit

_SHARE = 0.01
"""Share of the samples at an extreme value from which it may be the end of the range."""
_STAYS = 4
"""Samples in a row at that value, at least: noise does not repeat a peak."""
_PILE, _NEAR = 3.0, 5
"""How many times as often as each of the next values: a steady speed in counts is at a few values, too."""
_VALUES = 16
"""Distinct values of a channel from which its extremes say something."""
_FROZEN_FORCE, _FROZEN_VELOCITY = 0.25, 0.1  # [s]
_LIVELY = 0.5
"""Share of the other samples that change, from which repeated ones are suspicious."""
_RADII = (0.002, 0.030)
"""Radii r that the pad of a gripper may have [m]: rim contacts of 3 to 45 mm."""
_USUAL = 0.008  # [m]
_SLIDES, _TURNS = 2e-3, 0.02
"""Speed [m/s] and rate [rad/s] above the noise and the counts of a slip-velocity sensor."""
_FORCE, _TORQUE = 0.1, 2e-3
"""Force [N] and torque [N m] above noise and zero errors."""
_LEVERS = (0.001, 0.003)
"""Torque over force from which r may be too small, or too large [m]: an offset of the CoP makes r large."""
_LONGEST, _FASTEST, _DOUBTED = 0.04, 0.4, 0.4
"""Torque over normal force [m] and speed [m/s] that no grip has; the share of them from which they are named
where the radius is too large, too."""
_ENOUGH = 20  # samples
_LONG = 0.5
"""Way of one slip that no object in a grip has [m]: one that falls is fast, too."""


def reading_warnings(record: Record, samples: Samples) -> list[str]:
    """A line for each fault that the readings of a record show, with its samples as given to an estimator."""
    force = record.wrench if record.cop is None else record.wrench[:, :3]  # a torque that was moved is mixed
    names = WRENCH[: force.shape[1]]
    lines = [
        *filter(None, [record.doubt]),
        *_held(record),
        *_saturated(names, force),
        *_saturated(TWIST, record.twist),
        *_frozen_forces(names, record.force_t, force, record),
        *_frozen_velocity(record),
        *_alike(names, force),
        *_alike(TWIST, record.twist),
        *_units(samples),
    ]
    return [f"Warning: {line}" for line in lines]


def _held(record: Record) -> list[str]:
    if record.hold is None:
        return []
    return [
        f"the velocities are held: rows repeat each for {1e3 * record.hold:.3g} ms. They are read as samples "
        f"at {1.0 / record.hold:.0f} Hz; better write each once, and leave the cells of other rows empty."
    ]


def _saturated(names: tuple[str, ...], values: Array) -> list[str]:
    lines = []
    for name, channel in zip(names, values.T, strict=True):
        channel = np.round(channel, 9)  # not the last bits of sums of counts
        found, counts = np.unique(channel, return_counts=True)
        if len(found) < _VALUES:
            continue
        for word, inwards in (("largest", slice(None, None, -1)), ("smallest", slice(None))):
            extreme, often = found[inwards][0], counts[inwards]
            share = often[0] / len(channel)
            piled = often[0] > _PILE * often[1 : 1 + _NEAR].max()
            if extreme != 0.0 and share >= _SHARE and piled and _runs(channel == extreme)[1].max() >= _STAYS:
                lines.append(
                    f"{name} has its {word} value, {extreme:.4g}, in {100.0 * share:.0f} % of the samples: "
                    f"is that the end of the sensor's range{', or a held speed' * (names == TWIST)}?"
                )
    return lines


def _frozen_forces(names: tuple[str, ...], t: Array, force: Array, record: Record) -> list[str]:
    """Forces that stop changing while others, or the velocities, do not."""
    changes = np.diff(force, axis=0) != 0.0
    new = changes.any(axis=1)  # rows that are no repetition of the one before
    if new.any() and (moving := _longest(~new)) is not None:
        begin, end = t[moving[0]], t[moving[1]]
        inside = (record.twist_t >= begin) & (record.twist_t <= end)
        alive = len(np.unique(record.twist[inside], axis=0)) > 2
        others = np.sort(_runs(~new)[1])[:-1]  # of a sensor that is slower than the record
        usual = np.quantile(others, 0.95) if len(others) else 0.0
        long = end - begin > max(_FROZEN_FORCE, 20.0 * usual * period(t))
        if alive and long:
            return [_says("the forces do", begin, end, "while the object slips")]
    lines = []
    times = t[1:][new]
    for name, changed, channel in zip(names, changes[new].T, force.T, strict=True):
        run = _longest(~changed)
        if run is None:
            continue
        value = channel[1:][new][run[0]]
        if value in (channel.min(), channel.max()) or (run[0] == 0 and value == 0.0):
            continue  # saturated, or a component without load that is seen without noise
        others = np.delete(changed, slice(run[0], run[1] + 1))
        long = times[run[1]] - times[run[0]] > _FROZEN_FORCE
        if long and len(others) and others.mean() >= _LIVELY:
            lines.append(_says(f"{name} does", times[run[0]], times[run[1]], "while the other forces do"))
    return lines


def _frozen_velocity(record: Record) -> list[str]:
    """A twist that is not zero and repeats itself exactly; zero is what a sensor at rest reads."""
    twist, t = record.twist, record.twist_t
    slips = (twist[1:] != 0.0).any(axis=1)
    same = slips & (twist[1:] == twist[:-1]).all(axis=1)
    run = _longest(same)
    if run is None or t[run[1] + 1] - t[run[0]] <= _FROZEN_VELOCITY:
        return []
    slips[run[0] : run[1] + 1] = False
    if not slips.any() or (~same[slips]).mean() < _LIVELY:
        return []
    return [_says("the velocities do", t[run[0]], t[run[1] + 1], "and are not zero")]


def _alike(names: tuple[str, ...], values: Array) -> list[str]:
    """Pairs of channels that have the same values."""
    return [
        f"{first} and {second} have the same values: is one column read twice?"
        for (first, a), (second, b) in combinations(zip(names, values.T, strict=True), 2)
        if np.array_equal(a, b) and len(np.unique(a)) > 2
    ]


def _units(samples: Samples) -> list[str]:
    """Compares torque, speed and r^2 = tau v_t / (f_t omega), which any limit surface has about, with pads.

    A torque in another unit changes the lever and r, a velocity the speed and r, a rate r alone.
    """
    smallest, largest = _radius(samples, _LEVERS[0]), _radius(samples, _LEVERS[1]) or 0.0
    wide = largest > _RADII[1]
    longest, fastest = (_DOUBTED if wide else 1.0) * np.array([_LONGEST, _FASTEST])
    force, torque = np.quantile(np.abs(samples.wrench[:, 2:]), 0.95, axis=0)
    if (lever := float(torque / max(force, 1.0))) > longest:
        unit = likely_unit("tau", lever, USUAL_LEVER)
        return [
            f"tau is {1e3 * lever:.3g} mm times f_n, a longer lever than a pad has: is it in {unit}? `tau: "
            f"{{unit: {unit}}}` in the mapping says so. Or was it taken far from the pad, without its CoP?"
        ]
    v_t = np.hypot(*samples.twist[:, :2].T)
    most = np.count_nonzero(v_t > fastest) >= max(_ENOUGH, 0.5 * np.count_nonzero(v_t > _SLIDES))
    if most and _farthest(samples.t, v_t, v_t > fastest) > _LONG:
        unit = likely_unit("v_x", float(np.median(v_t[v_t > fastest])), USUAL_SPEED)
        return [
            f"most slip is faster than {fastest:.2g} m/s, as in no grip: are v_x and v_y in {unit}? `v_x: "
            f"{{unit: {unit}}}` and `v_y: {{unit: {unit}}}` in the mapping say so."
        ]
    if wide:
        return [
            f"rate, velocity and forces fit a radius r of {1e3 * largest:.3g} mm, more than a pad has: is "
            "omega too small by its unit, are v_x and v_y too large by theirs, or is the CoP wrong?"
        ]
    if smallest is None or smallest >= _RADII[0]:
        return []
    unit = likely_unit("omega", (_USUAL / smallest) ** 2, 1.0)
    return [
        f"rate, velocity and forces fit a radius r of {1e3 * smallest:.3g} mm, less than a pad has: is omega "
        f"in {unit}? `omega: {{unit: {unit}}}` in the mapping says so."
    ]


def _radius(samples: Samples, lever: float) -> float | None:
    """Median of that r over the slip whose torque has at least this lever [m]; None: too few samples."""
    f_t, v_t = np.hypot(*samples.wrench[:, :2].T), np.hypot(*samples.twist[:, :2].T)
    tau, omega = np.abs(samples.wrench[:, 3]), np.abs(samples.twist[:, 2])
    both = (v_t > _SLIDES) & (omega > _TURNS) & (f_t > _FORCE) & (tau > np.maximum(_TORQUE, lever * f_t))
    if np.count_nonzero(both) < _ENOUGH:
        return None
    return float(np.sqrt(np.median(tau[both] * v_t[both] / (f_t[both] * omega[both]))))


def _says(what: str, begin: float, end: float, meanwhile: str) -> str:
    return f"{what} not change from {seconds(begin)} to {seconds(end)} s, {meanwhile}: is the reading frozen?"


def _runs(flags: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Begin and length of each run of True."""
    edges = np.flatnonzero(np.diff(flags, prepend=False, append=False))
    return edges[::2], edges[1::2] - edges[::2]


def _farthest(t: Array, v_t: Array, flags: NDArray[np.bool_]) -> float:
    """Largest way within a run of True [m]."""
    ways = np.where(flags, v_t, 0.0) * np.diff(t, prepend=t[0])
    runs = np.cumsum(np.diff(flags, prepend=False) & flags)
    return float(np.bincount(runs, ways).max())


def _longest(flags: NDArray[np.bool_]) -> tuple[int, int] | None:
    """First and last place of the longest run of True."""
    begins, lengths = _runs(flags)
    if not len(begins):
        return None
    k = int(np.argmax(lengths))
    return int(begins[k]), int(begins[k] + lengths[k]) - 1
