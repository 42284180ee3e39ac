"""Draws the limit surface of both pads with the present load on it, as SVG.

With slip velocity v and rate omega, two ellipsoidal pads in steady slip give together (Waltersson and
Karayiannidis, arXiv 2507.06824, eqs 1-2)

    f_t = sum mu_i n_i cos(phi_i),   tau = sum mu_i n_i r_i sin(phi_i),   tan(phi_i) = r_i omega / v.

The load on the object, weight and pushes with what accelerates it, lies inside while the object sticks.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Any

import numpy as np

from slipgym.rendering.look import feel

WIDTH, HEIGHT = 400, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 12, 6, 36
_RATIOS = np.tan(np.linspace(-0.5, 0.5, 41)[1:-1] * math.pi)  # r omega / v
_STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
_TRAIL = 20
_HEAD = (
    f'<svg class="ls" viewBox="0 0 {WIDTH} {HEIGHT}" style="--truth:#767676;width:100%;display:block">'
    "<style>.ls text{font:11px sans-serif;fill:#767676}.ls .rule{stroke:#8884;stroke-width:1}</style>"
)


def boundary(mu: np.ndarray, normal: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Friction of both pads in steady slip, over the direction of slip from spin to spin.

    Args:
        mu: Friction coefficient of each pad, (2,) [-].
        normal: Normal force of each, (2,) [N].
        radius: Radius of the equivalent rim contact of each, (2,) [m].

    Returns:
        Torque and tangential force, (41, 2) [N m, N].
    """
    mean = max(float(np.mean(radius)), 1e-9)
    angle = np.arctan(np.concatenate(([-np.inf], _RATIOS, [np.inf]))[:, None] * radius / mean)
    force = mu * normal
    return np.column_stack([(force * radius * np.sin(angle)).sum(1), (force * np.cos(angle)).sum(1)])


class SurfacePlot:
    """The limit surface at present: true, estimated with its deviation, and the load's last positions."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Forget the last episode."""
        self._trail: deque[tuple[float, float]] = deque(maxlen=_TRAIL)
        self._reach = [0.0, 0.0]

    def draw(self, simulation: Any, info: Any) -> str:
        """An SVG element of the present state; each call appends the load to its trail."""
        friction, torque, grip = feel(simulation, 0)
        normal, truth = np.array(grip), np.asarray(info["true_per_finger"])
        self._trail.append((torque, math.hypot(*friction)))
        static = boundary(truth[:, 0], normal, truth[:, 2])
        coulomb = boundary(truth[:, 1], normal, truth[:, 2])
        _, mu_c, r, _, confidence = simulation.estimated[0, :5].tolist()
        deviation = float(simulation.estimated[0, 7])
        self._grow(static)
        grey = "var(--truth)"
        shapes = [self._path(static, grey, "4 3", 1.2), self._path(coulomb, grey, "", 1.8)]
        if confidence > 0.0:
            values = np.maximum([mu_c - deviation, mu_c, mu_c + deviation], 0.0)
            low, middle, high = (boundary(np.full(2, mu), normal, np.full(2, r)) for mu in values)
            if deviation < 1.0:
                around = self._points(np.concatenate([low, high[::-1]]))
                shapes.insert(0, f'<polygon points="{around}" fill="#D55E00" fill-opacity="0.22"/>')
            shapes.append(self._path(middle, "#D55E00", "", 2.2))
        return f"{_HEAD}{self._axes()}{''.join(shapes)}{self._load()}</svg>"

    def _grow(self, curve: np.ndarray) -> None:
        """Choose round limits of the axes, which follow the surface without jitter."""
        for k, value in enumerate((1e3 * curve[:, 0].max(), curve[:, 1].max())):
            wanted = 1.15 * max(float(value), 0.2)
            if not 0.45 * self._reach[k] < wanted <= self._reach[k]:
                self._reach[k] = 1.25 * wanted

    def _place(self, points: Any) -> np.ndarray:
        """Pixels of torques [N m] and forces [N], (n, 2)."""
        torque, force = np.asarray(points, dtype=float).reshape(-1, 2).T
        inner, height = WIDTH - _LEFT - _RIGHT, HEIGHT - _TOP - _BOTTOM
        x = _LEFT + inner * (0.5 + 0.5 * 1e3 * torque / self._reach[0])
        return np.column_stack([x, _TOP + height * (1.0 - force / self._reach[1])])

    def _path(self, curve: np.ndarray, colour: str, dash: str, width: float) -> str:
        style = f'fill="none" stroke="{colour}" stroke-width="{width}" stroke-dasharray="{dash}"'
        return f'<polyline points="{self._points(curve)}" {style}/>'

    def _points(self, curve: np.ndarray) -> str:
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in self._place(curve).tolist())

    def _load(self) -> str:
        places, count, parts = self._place(list(self._trail)).tolist(), len(self._trail), []
        for k, (x, y) in enumerate(places, 1):
            style = f'r="2" fill="#0072B2" fill-opacity="{(k - 1) / count:.2f}"'
            style = style if k < count else 'r="5" fill="#0072B2" stroke="white"'
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" {style}/>')
        return "".join(parts)

    def _axes(self) -> str:
        parts = []
        bottom, (width, height) = HEIGHT - _BOTTOM, self._reach
        for value in _ticks(-width, width):
            x = self._place((1e-3 * value, 0.0))[0, 0]
            parts.append(f'<path d="M{x:.1f} {_TOP}V{bottom}" class="rule"/>')
            parts.append(f'<text x="{x:.1f}" y="{bottom + 14}" text-anchor="middle">{value:g}</text>')
        for value in _ticks(0.0, height):
            y = self._place((0.0, value))[0, 1]
            parts.append(f'<path d="M{_LEFT} {y:.1f}H{WIDTH - _RIGHT}" class="rule"/>')
            parts.append(f'<text x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')
        middle = (_LEFT + WIDTH - _RIGHT) / 2
        parts.append(f'<text x="{middle}" y="{HEIGHT - 8}" text-anchor="middle">torque [mN m]</text>')
        upright = f'transform="translate(13 {(_TOP + bottom) / 2}) rotate(-90)" text-anchor="middle"'
        parts.append(f"<text {upright}>tangential force [N]</text>")
        return "".join(parts)


def _ticks(low: float, high: float) -> list[float]:
    """Round numbers between two limits, about five of them."""
    step = next((each for each in _STEPS if (high - low) / each <= 6.0), 100.0)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [step * k for k in range(first, last + 1)]
