"""Plots beside the 3-D view: friction over time, grip and slip over time, the limit surface.

The limit surface of both pads, with the present load on it, is drawn as SVG. With slip velocity v and rate
omega, two ellipsoidal pads in steady slip give together (Waltersson and Karayiannidis, arXiv 2507.06824,
eqs 1-2)

    f_t = sum mu_i n_i cos(phi_i),   tau = sum mu_i n_i r_i sin(phi_i),   tan(phi_i) = r_i omega / v.

The load on the object, weight and pushes with what accelerates it, lies inside while the object sticks.
"""

from __future__ import annotations

import html
import math
from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np

from policies.play.viewer.session import Session
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History
from slipgym.rendering.look import feel
from slipgym.rendering.plot import spacing

ORANGE, GREEN, BLUE, LIGHT, GREY = "#D55E00", "#009E73", "#0072B2", "#56B4E9", "#767676"
RATE = 30
"""Points of a curve per second of simulation."""
_KNOWN = 10.0  # deviations from here on mean that nothing is known
_GRIP = ("grip_1", "grip_2")
_PATH = ("path", "reference")
_KEY = (
    '<div style="font-size:12px;line-height:1.35;padding:0 4px 2px">'
    f'<b style="color:{ORANGE}">estimated</b> mu_c &plusmn; one deviation; '
    f'<b style="color:{GREY}">true</b> mu_c (solid), mu_s (dashed); <b style="color:{BLUE}">load</b>, '
    "which slips where it reaches the surface</div>"
)
WIDTH, HEIGHT = 400, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 12, 6, 36
_RATIOS = np.tan(np.linspace(-0.5, 0.5, 41)[1:-1] * math.pi)  # r omega / v
_TRAIL = 20
_HEAD = (
    f'<svg class="ls" viewBox="0 0 {WIDTH} {HEIGHT}" style="--truth:#767676;width:100%;display:block">'
    "<style>.ls text{font:11px sans-serif;fill:#767676}.ls .rule{stroke:#8884;stroke-width:1}</style>"
)


class Plots:
    """The plots of a session, in the container of `viser.ViserServer.gui` that is open."""

    def __init__(self, gui: Any, session: Session) -> None:
        self._session, self._surface = session, SurfacePlot()
        history, motion = session.history, session.env.task.motion
        edge = _line("", "rgba(0,0,0,0)", 0)
        edges = [{**edge, "auto": False}] * 4
        paints = ([2, 1], "rgba(213,94,0,0.22)"), ([4, 3], "rgba(0,158,115,0.18)")
        bands = [{"series": series, "fill": colour} for series, colour in paints]
        frictions = (
            *(_line("mu_c estimated", ORANGE, 2), _line("mu_s estimated", GREEN, 2)),
            *(_line("mu_c true", ORANGE, 1.2, [6, 4]), _line("mu_s true", GREEN, 1.2, [6, 4])),
        )
        title = "friction [-]: estimated ± one deviation, true dashed"
        self._friction = _plot(
            gui, _friction(history), (*edges, *frictions, edge, edge), title, 155, bands=bands
        )
        self._off = gui.add_html("")
        with gui.add_folder("limit surface of both pads"):
            self._dome = gui.add_html("")
            gui.add_html(_KEY)
        fingers = _line("finger 1", GREY, 2), _line("finger 2", LIGHT, 1.5)
        self._grip = _plot(gui, curves(history, *_GRIP), fingers, "grip force [N]", 100)
        paths = _line(motion.title, BLUE, 2), _line("reference", BLUE, 1.2, [6, 4])
        self._path = _plot(gui, curves(history, *_PATH), paths, motion.title, 100)
        self.update()

    def begin(self) -> None:
        """Begin the plots of an episode that was just reset."""
        self._surface.begin()
        self.update()

    def update(self) -> None:
        """Send the present rows."""
        history: History = self._session.history
        self._friction.data = _friction(history)
        self._grip.data = curves(history, *_GRIP)
        self._path.data = curves(history, *_PATH)
        self._off.content = _notes(self._session.env.discrepancies(), self._session.env.simulation.estimating)
        self._dome.content = self._surface.draw(self._session.env.simulation, self._session.info)


def curves(history: History, *names: str) -> tuple[np.ndarray, ...]:
    """Time [s] and some of `slipgym.rendering.history.COLUMNS`, thinned to `RATE`, each (n,)."""
    kept = np.flatnonzero(np.isfinite(history.column("grip_1")))  # frame_skip leaves rows out
    every = max(1, round(1.0 / (RATE * history.step_time)))
    kept = kept[np.unique(kept // every, return_index=True)[1]]
    return history.times[kept], *(history.column(name)[kept] for name in names)


def _friction(history: History) -> tuple[np.ndarray, ...]:
    """Curves of the plot of friction, and two that set the limits of its axis, without NaN."""
    time, *values, true_c, true_s = curves(
        history, "mu_c", "mu_s", "sd_mu_c", "sd_mu_s", "true_mu_c", "true_mu_s"
    )
    bands = []
    for value, deviation in zip(values[:2], values[2:], strict=True):
        known = deviation < _KNOWN
        known &= np.isfinite(value)
        # a page fills a band from the gap before it: where nothing is known, the band has no width
        middle = np.where(known, value, value[known][0] if known.any() else 0.0)
        reach = np.where(known, deviation, 0.0)
        bands += [np.maximum(middle - reach, 0.0), middle + reach]
    zero = np.zeros_like(time)
    return time, *bands, *values[:2], true_c, true_s, zero, zero + 1.2 * true_s.max()


def _notes(off: Sequence[Discrepancy], estimating: bool) -> str:
    """Estimates that are off, and why, as HTML, of a height that keeps the plots in place."""
    lines = [
        f'<div data-name="off {name}"><b style="color:{GREEN if name == "mu_s" else ORANGE}">{name}</b> '
        f"{html.escape(error)}: {html.escape(reason)}</div>"
        for name, error, reason in off
    ]
    none = "no estimate is off" if estimating else "nothing is estimated"
    lines = lines or [f'<div style="color:{GREY}">{none}</div>']
    style = "font-size:11px;line-height:1.25;min-height:5em;padding:0 10px"
    return f'<div style="{style}">{"".join(lines)}</div>'


def _plot(gui: Any, data: Any, lines: Any, title: str, height: int, **more: Any) -> Any:
    grid = {"stroke": "rgba(136,136,136,0.25)", "width": 1}
    axis = {"stroke": GREY, "grid": grid, "ticks": {"show": False}, "font": "11px sans-serif"}
    return gui.add_uplot(
        data,
        ({"label": "t"}, *lines),
        title=title,
        scales={"x": {"time": False, "auto": True}, "y": {"auto": True}},
        axes=({**axis, "size": 28}, {**axis, "size": 44}),
        legend={"show": False},
        padding=(8, 16, 0, 0),
        height=height,
        **more,
    )


def _line(label: str, colour: str, width: float, dash: list[int] | None = None) -> dict[str, Any]:
    line = {"label": label, "auto": "estimated" not in label, "stroke": colour, "width": width}
    return {**line, "points": {"show": False}, **({"dash": dash} if dash else {})}


def boundary(mu: np.ndarray, normal: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Friction of both pads in steady slip, over the direction of slip from spin to spin.

    It is torque and tangential force, (41, 2) [N m, N], by friction coefficient [-], normal force [N] and
    radius of the equivalent rim contact [m] of each pad, (2,).
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
        grey = "var(--truth)"
        values = np.maximum([mu_c - deviation, mu_c, mu_c + deviation], 0.0)
        low, middle, high = (boundary(np.full(2, mu), normal, np.full(2, r)) for mu in values)
        self._grow(np.concatenate([static, middle]) if confidence > 0.0 else static)
        shapes = [self._path(static, grey, "4 3", 1.2), self._path(coulomb, grey, "", 1.8)]
        if confidence > 0.0:
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
    """Round numbers between two limits, at most five of them, and one above 0."""
    step = next(step for step in (spacing(high - low), spacing(high)) if step <= high)
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
