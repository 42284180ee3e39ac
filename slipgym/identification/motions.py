"""Describes the six motions of a session on the bench, and ranks them by what more of each would show."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from slipgym.identification.fit import Result, slopes
from slipgym.identification.parameters import DEVIATION, PARAMETERS

Motion = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Time (n,) [s] -> grip command (n,) [N], twist (n, 3) [m/s, m/s, rad/s]."""


def _steps(t: np.ndarray, forces: tuple[float, ...], hold: float) -> np.ndarray:
    return np.array(forces)[(t // hold).astype(int) % len(forces)]


def _sway(t: np.ndarray, amplitude: float, period: float) -> np.ndarray:
    return amplitude * np.sin(2.0 * np.pi * t / period)


def _twist(
    t: np.ndarray, x: np.ndarray | float, y: np.ndarray | float, turn: np.ndarray | float
) -> np.ndarray:
    return np.stack([np.broadcast_to(each, t.shape) for each in (x, y, turn)], axis=1).astype(float)


MOTIONS: dict[str, Motion] = {
    "press": lambda t: (_steps(t, (3.0, 8.0, 5.0, 12.0), 0.5), _twist(t, 0, 0, 0)),
    "slide x": lambda t: (_steps(t, (5.0, 8.0), 5.0), _twist(t, _sway(t, 0.02, 2.0), 0, 0)),
    "slide y": lambda t: (_steps(t, (4.0, 10.0), 5.0), _twist(t, 0, _sway(t, 0.02, 2.0), 0)),
    "creep": lambda t: (_steps(t, (5.0, 9.0), 5.0), _twist(t, _sway(t, 0.003, 5.0), 0, 0)),
    "turn": lambda t: (_steps(t, (3.0, 6.0, 12.0), 3.4), _twist(t, 0, 0, _sway(t, 1.0, 2.5))),
    "slide and squeeze": lambda t: (
        _steps(t, (3.0, 10.0, 6.0, 14.0), 1.2),
        _twist(t, _sway(t, 0.02, 2.2), _sway(t, 0.01, 3.1), _sway(t, 0.8, 1.7)),
    ),
}
"""The motions of ten seconds, in the order of a session; each begins at rest."""
LENGTH = 20.0
"""Of a motion that is recorded next [s]."""


def gains(result: Result) -> list[tuple[str, float, str]]:
    """(motion, sum over the parameters of the relative fall of the deviation, what falls most), best first.

    The information of the log is scaled such that it gives the deviations found, which are wider than those
    of white noise; the new motion's is scaled by the same factor.
    """
    present = ~np.isnan(result.noise)
    noise = result.noise / np.sqrt(np.isfinite(result.log.readings).mean(axis=0))  # of rows, some without
    before = np.sqrt(np.diag(np.linalg.inv(result.information)))
    widened = np.median((result.deviation / before)[result.shown]) if result.shown.any() else 1.0
    prior = np.diag(DEVIATION**-2.0)
    data = (result.information - prior) / widened**2
    before = np.sqrt(np.diag(np.linalg.inv(data + prior)))
    rate, ranked = result.log.rate, []
    for name, motion in MOTIONS.items():
        moves = motion(np.arange(round(LENGTH * rate)) / rate)
        of = slopes(result.point, rate, *moves, contact=result.contact, pressure=result.pressure)
        of = (of[:, :, present] / noise[present] / widened).reshape(len(of), -1)
        after = np.sqrt(np.diag(np.linalg.inv(data + prior + of @ of.T)))
        fall = 1.0 - after / before
        ranked.append((name, float(fall.sum()), PARAMETERS[int(np.argmax(fall))].name))
    return sorted(ranked, key=lambda each: -each[1])
