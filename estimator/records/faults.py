"""Warns about what streams say of each other: a force zeroed in the grip, dead channels, clocks, signs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from estimator.online import TWIST, WRENCH
from estimator.records.alignment import Samples, newest, period
from estimator.records.record import Array, Record

_SLIDES = 2e-3
"""Speed above the noise and the counts of a sensor [m/s]."""
_FORCE = 0.3
"""Force above noise and zero errors [N]."""
_FRICTION = 3.0
"""Largest friction coefficient of a fingertip."""
_ZERO = 0.1
"""Usual zero error of a normal force [N]."""
_FEW, _PART_OF_SLIP = 5, 0.05
"""Samples, and their share of the slip, in which a force is no single peak."""
ENOUGH = 20  # samples
_LATEST, _EARLIEST = 5, -1
"""Delays of the velocity that a sensor may have, and that "adaptive" looks for [samples]."""
_FARTHEST = 0.5
"""Largest offset of two clocks that is looked for [s]."""
_LOOKED_AT = 20_000
"""Velocity samples in which it is looked for."""
_SEEN, _CHANCE, _CLEARLY = 0.25, 2.0, 1.4
"""Correlation of an offset that is believed; the same times the root of the number of changes, since few of
them correlate by chance; and how much larger than that of any usual delay it must be."""
_AXES = ((0, 0), (1, 1), (3, 2))
"""Components of the wrench and of the twist that go along with each other."""
_CLEAR, _TURNS, _LOADED, _TORQUE, _LEVER = 3e-3, 0.1, 0.5, 3e-3, 0.003
"""Speed [m/s], rate [rad/s], force [N], torque [N m] torque over force [m] at which their signs are clear."""
_PART, _USUAL, _WAY, _MOST = 0.6, 0.008, 2e-3, 0.8
"""Share of the axis in the motion, by the usual radius r [m]; way of the samples [m], farther than a pad
springs back; the share of them that shows the sign."""


def fault_warnings(record: Record, samples: Samples) -> list[str]:
    """A line for each fault of a record, as read, with its samples as given to an estimator."""
    lines = [*_zeroed(record, samples), *_own_force(record), *_dead(record), *_two_clocks(record)]
    return [f"Warning: {line}" for line in (*lines, *_against(samples))]


def _zeroed(record: Record, samples: Samples) -> list[str]:
    """A normal force that is too low for its friction, or below zero."""
    f_n, force = record.wrench[:, 2], np.hypot(*samples.wrench[:, :2].T)
    low, high = np.quantile(f_n, (0.01, 0.99))
    if low < -max(_FORCE, 0.1 * high):
        return [
            f"f_n goes down to {low:.3g} N, but nothing pulls at a pad: was it zeroed in the grip? Zero it "
            f"with the open gripper, or add the grip that it had then by `f_n: {{offset: …}}`: {-low:.3g} N "
            "or more, which the readings do not show. A smaller one leaves friction too large."
        ]
    loaded = slides(samples) & (force > _FORCE)
    if np.count_nonzero(loaded) < ENOUGH:
        return []
    force, pressed = force[loaded], samples.wrench[loaded, 2]
    if (ratio := float(np.median(force / np.maximum(pressed, 1e-9)))) > _FRICTION:
        return [
            f"in slip the tangential force is {min(ratio, 999.0):.3g} times f_n, more than friction can be: "
            "was f_n zeroed in the grip? Zero it with the open gripper; `f_n: {offset: …}` adds a force."
        ]
    noise = float(np.median(np.abs(np.diff(f_n)))) / 0.95  # of a difference of two samples
    lacks = force > _FRICTION * (pressed + _ZERO + 3.0 * noise)
    if np.count_nonzero(lacks) >= max(_FEW, _PART_OF_SLIP * len(lacks)):
        return [
            f"in {100.0 * lacks.mean():.0f} % of the slip f_n is less than a third of the tangential force, "
            f"down to {pressed.min():.3g} N, and no friction is so large: was f_n zeroed in the grip? Zero "
            "it with the open gripper; `f_n: {offset: …}` adds a force."
        ]
    return []


def slides(samples: Samples) -> NDArray[np.bool_]:
    """Finds the samples that slip along the pad faster than noise and counts, (m,)."""
    return np.hypot(*samples.twist[:, :2].T) > _SLIDES


def _own_force(record: Record) -> list[str]:
    """The gripper's own force against the normal force."""
    if record.grip is None:
        return []
    f_n = record.wrench[:, 2]
    pressed = np.isfinite(record.grip) & ((record.grip > 1.0) | (f_n > 1.0))
    if np.count_nonzero(pressed) < ENOUGH:
        return []
    own, measured = float(np.median(record.grip[pressed])), float(np.median(f_n[pressed]))
    if abs(own - measured) <= 0.3 * max(abs(own), abs(measured)):
        return []
    return [
        f"the gripper's own force is {own:.3g} N where f_n is {measured:.3g} N: was f_n zeroed in the grip, "
        "is one of them in another unit, or is the own force that of both fingers or of the motor?"
    ]


def _dead(record: Record) -> list[str]:
    """Channels that have one value from the first to the last sample, while others have not."""
    force = record.wrench if record.cop is None else record.wrench[:, :3]  # a torque that was moved is mixed
    streams = {"force": (WRENCH, force), "velocity": (TWIST, record.twist)}
    lines = []
    for what, (names, values) in streams.items():
        still = (values == values[0]).all(axis=0)
        if still.all() and values[0].any() and not (what == "velocity" and _steady(record)):
            lines.append(f"no {what} ever changes: is the sensor frozen, or not connected?")
        elif what == "force":
            dead = [name for name, value, is_ in zip(names, values[0], still, strict=False) if is_ and value]
            if dead:
                lines.append(f"{', '.join(dead)} never changes: is it frozen, or not connected?")
    return lines


def _steady(record: Record) -> bool:
    """Whether friction is as steady as that of a slip at one speed."""
    pressed = record.wrench[:, 2] > _FORCE
    ratio = np.hypot(*record.wrench[pressed, :2].T) / record.wrench[pressed, 2]
    return bool(pressed.all() and ratio.std() <= 0.1 * ratio.mean())


def _two_clocks(record: Record) -> list[str]:
    """An offset between forces and velocities that no sensor's delay explains.

    Friction changes where the motion changes. The correlation of both changes, by the delay between them,
    is largest at the true one.
    """
    t, twist = record.twist_t[:_LOOKED_AT], record.twist[:_LOOKED_AT]
    step = period(t)
    most = int(_FARTHEST / step)
    if len(t) < 4 * most or most <= _LATEST:
        return []
    scales = np.array([1.0, 1.0, 0.01])
    change = np.diff(twist * scales, n=2, axis=0)
    lags = np.arange(-most, most + 1)
    found = np.zeros(len(lags))
    force = record.wrench[:, [0, 1, 3]] / scales
    for k, lag in enumerate(lags):
        at = np.clip(newest(record.force_t, t - lag * step), 0, None)
        found[k] = _correlation(change, force[at])
    usual = (lags >= _EARLIEST - 1) & (lags <= _LATEST + 1)
    best = int(np.argmax(found))
    energy = np.square(change).sum(axis=1)
    if not energy.any():
        return []
    changes = energy.sum() ** 2 / np.square(energy).sum()
    if usual[best] or found[best] < max(_SEEN, _CHANCE / np.sqrt(changes), _CLEARLY * found[usual].max()):
        return []
    lag = lags[best] * step
    return [
        f"the velocities change {1e3 * abs(lag):.0f} ms {'after' if lag > 0 else 'before'} the forces: are "
        f"there two clocks? `velocity_t: {{offset: {-lag:+.3f}}}` in seconds, with its column, corrects it."
    ]


def _correlation(change: Array, force: Array) -> float:
    """Of second differences of velocities, (n - 2, 3), with changes of the forces, smoothed as these are."""
    moved = force[2:] - force[:-2]
    energy = float((moved * moved).sum() * (change * change).sum())
    return abs(float((moved * change).sum())) / np.sqrt(energy) if energy > 0.0 else 0.0


def _against(samples: Samples) -> list[str]:
    """Axes along which the force goes against the slip: friction takes energy from the motion along each."""
    wrench, twist = samples.wrench, samples.twist * [1.0, 1.0, _USUAL]
    speed, force = np.linalg.norm(twist, axis=1), np.hypot(*wrench[:, :2].T)
    least = _LOADED, _LOADED, np.maximum(_TORQUE, _LEVER * force)
    slowest = _CLEAR, _CLEAR, _USUAL * _TURNS
    shown, against = 0, []
    for (k, axis), loaded, slow in zip(_AXES, least, slowest, strict=True):
        along, moved = wrench[:, k], twist[:, axis]
        clear = (np.abs(moved) > np.maximum(slow, _PART * speed)) & (np.abs(along) > loaded)
        way = float(np.abs(moved * np.diff(samples.t, prepend=samples.t[0]))[clear].sum())
        if np.count_nonzero(clear) >= ENOUGH and way > _WAY:
            shown += 1
            if (along * moved < 0.0)[clear].mean() > _MOST:
                against.append((WRENCH[k], TWIST[axis]))
    if shown == len(against) > 1:
        turns = ", ".join(f"`{name}: {{sign: -1}}`" for name, _ in against)
        return [
            "the forces go against the slip, but friction goes along with it: are they those of the "
            f"pad on the object? {turns} in the mapping turn them."
        ]
    return [
        f"{force} goes against {speed} in slip, but friction goes along with it: one of them has "
        f"the wrong sign. `{speed}: {{sign: -1}}` or `{force}: {{sign: -1}}` in the mapping turns it."
        for force, speed in against
    ]
