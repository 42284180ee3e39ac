"""Plots beside the 3-D view: friction over time, grip and slip over time, the limit surface."""

from __future__ import annotations

import html
from collections.abc import Sequence
from typing import Any

import numpy as np

from policies.play.viewer.session import Session
from policies.play.viewer.surface import SurfacePlot
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History

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


class Plots:
    """The plots of a session, in the container of `viser.ViserServer.gui` that is open."""

    def __init__(self, gui: Any, session: Session) -> None:
        self._session, self._surface = session, SurfacePlot()
        history, motion = session.history, session.env.task.motion
        edge = _line("", "rgba(0,0,0,0)", 0)
        edges = [{**edge, "auto": False}] * 4
        bands = (_band(2, 1, "rgba(213,94,0,0.22)"), _band(4, 3, "rgba(0,158,115,0.18)"))
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
        reach = np.where(deviation < _KNOWN, deviation, np.nan)
        bands += [np.maximum(value - reach, 0.0), value + reach]
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


def _band(high: int, low: int, colour: str) -> dict[str, Any]:
    return {"series": [high, low], "fill": colour}
