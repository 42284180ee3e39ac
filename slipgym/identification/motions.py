"""Describes the six motions of a session on the bench, ten seconds each."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

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
"""The motions, in the order of a session; each begins at rest."""
