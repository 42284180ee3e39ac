"""Pushes as a stream of samples for the estimators of a gripper.

Friction has neither a length nor a speed of its own here: lengths of the block are multiplied by one factor
so that its farthest corner lies on the rim of a pad, which leaves mu_c as it is, and every push becomes a
steady slip at one speed, between two rests under the same force, so that the age of the velocities mixes no
two pushes. Estimators are made by their name alone.
"""

from __future__ import annotations

import numpy as np

import estimator
from lab.pushes.extract import Pushes
from lab.pushes.support import CENTRE, LEG, WEIGHT

RATE = 120.0  # [Hz], of the slip-velocity sensor
PAD = 0.015
"""Radius of the pad that the block becomes [m]."""
LENGTH = PAD / float(np.hypot(LEG - CENTRE[0], CENTRE[1]))
"""Factor of all lengths."""
SPEED = 0.02
"""Scaled speed of every slip, with r half the pad's radius; as in the leaderboard [m/s]."""
REST, HOLD = 3, 6
"""Samples at rest before and after each slip, under its force; samples of the slip. 0.1 s altogether."""
LATENCY = 1
"""Age of the velocities, as of the realistic sensors [samples]."""
SAMPLES = HOLD + 2 * REST
PASSES = 2
"""Times that an estimator gets the log; the estimates of the last one count."""


def stream(pushes: Pushes, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Friction and slip of a pass, as the sensors of a finger see it.

    Args:
        pushes: Of one log.
        chosen: Numbers of the pushes, (k, n).

    Returns:
        Wrenches (f_x, f_y, f_n, tau) on the sliding block (samples, k, 4) [N, N, N, N m]; slip twists
        (samples, k, 3) [m/s, m/s, rad/s].
    """
    f_x, f_y, tau = -pushes.wrench[chosen].T  # (3, n, k): quasi-static, friction balances the pusher
    d_x, d_y, d_theta = pushes.displacement[chosen].T * np.array([LENGTH, LENGTH, 1.0])[:, None, None]
    per_s = SPEED / np.sqrt(d_x**2 + d_y**2 + (0.5 * PAD * d_theta) ** 2)
    slips = np.stack((f_x, f_y, np.full_like(f_x, WEIGHT), LENGTH * tau), axis=-1)
    twists = np.stack((d_x, d_y, d_theta), axis=-1)
    n, k = f_x.shape
    wrenches = np.repeat(slips, SAMPLES, axis=0)
    seen = np.zeros((n, SAMPLES, k, 3))
    begin = REST + LATENCY
    seen[:, begin : begin + HOLD] = twists[:, None] * per_s[:, None, :, None]
    return wrenches, seen.reshape(-1, k, 3)


def replay(
    name: str, pushes: Pushes, chosen: np.ndarray, **parameters: object
) -> tuple[np.ndarray, np.ndarray]:
    """What an estimator finds: the mean of its estimates after each push of the last pass.

    Args:
        name: Estimator.
        pushes: Of one log.
        chosen: Numbers of the pushes in each of k streams, (k, n).
        **parameters: Of the estimator.

    Returns:
        mu_c (k,) [-] and r (k,), in lengths of the block [m].
    """
    wrenches, twists = stream(pushes, chosen)
    batch = estimator.make_batch(name, len(chosen), **parameters)
    samples, found = len(wrenches), []
    for number in range(PASSES * samples):
        batch.update(number / RATE, wrenches[number % samples], twists[number % samples])
        if number >= (PASSES - 1) * samples and (number + 1) % SAMPLES == 0:
            found.append((batch.estimates["mu_c"].copy(), batch.estimates["r"] / LENGTH))
    mu_c, r = np.mean(found, axis=0)
    return mu_c, r
