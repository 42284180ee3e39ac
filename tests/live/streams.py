"""Streams of a gripper's readings, and the faults that networks and sensors add to them."""

import numpy as np

FORCE, VELOCITY = 1000.0, 120.0


def stick_slip(seconds: float, seed: int = 0, width: int = 6):
    """Readings of one finger, (kind, stamp, values) in order of time; slides, sticks and turns."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * FORCE)) / FORCE
    slides = np.sin(2 * np.pi * 0.5 * t) > 0.0
    f_n = 5.0 + np.sin(3.0 * t)
    mu = np.where(slides, 0.4, 0.25)
    wrench = np.column_stack((0.9 * mu * f_n, 0.1 * mu * f_n, f_n, 0.002 * mu * f_n))
    wrench = np.column_stack((wrench, 0.001 * f_n, -0.0005 * f_n))[:, :width]
    wrench = wrench + rng.normal(0.0, 0.01, wrench.shape) * [1, 1, 1, 1e-3, 1e-3, 1e-3][:width]
    s = np.arange(round(seconds * VELOCITY)) / VELOCITY + 0.0003
    moving = (np.sin(2 * np.pi * 0.5 * s) > 0.0)[:, None]
    twist = np.where(moving, np.array([0.02, 0.002, 0.5]) + rng.normal(0.0, 1e-3, (len(s), 3)), 0.0)
    readings = [("wrench", a, b) for a, b in zip(t.tolist(), wrench.tolist(), strict=True)]
    readings += [("twist", a, b) for a, b in zip(s.tolist(), twist.tolist(), strict=True)]
    return sorted(readings, key=lambda reading: reading[1])


def faulty(readings, seed: int = 0, lateness: float = 0.002, bursts: bool = True):
    """The readings as (kind, stamp, values, arrival): some drop, come twice, are NaN, or come late.

    Most delays stay within the lateness; one in 500 does not. In a burst all of 30 ms comes at once.
    """
    rng = np.random.default_rng(seed)
    sent = []
    for kind, t, values in readings:
        if rng.random() < 0.01:
            continue
        values = [float("nan"), *values[1:]] if rng.random() < 0.002 else values
        delay = rng.uniform(0.0, 0.9 * lateness) + (10.0 * lateness) * (rng.random() < 0.002)
        for _ in range(1 + (rng.random() < 0.005)):
            sent.append((t + 0.01 + delay, kind, t, values))
    sent.sort(key=lambda each: each[0])
    for arrival, kind, t, values in sent:
        if bursts and int(arrival) % 5 == 4 and arrival % 1.0 < 0.03:
            arrival = np.floor(arrival) + 0.03
        yield kind, t, values, float(arrival)


def feed(live, readings, finger: int = 1):
    """All outputs of a stream of (kind, stamp, values) or (kind, stamp, values, arrival)."""
    outputs = []
    for kind, t, values, *arrival in readings:
        take = live.feed_wrench if kind == "wrench" else live.feed_twist
        outputs += take(finger, t, values, arrival[0] if arrival else t)
    return outputs
