"""Sliders, buttons and menus of the viewer, and the line that says how the episode goes."""

from __future__ import annotations

import html
import math
from collections.abc import Callable
from typing import Any

from policies.play.viewer.interventions import PUSHES, TURNS
from policies.play.viewer.offers import Offer, number, one_of, switch
from policies.play.viewer.scene import PUSH
from policies.play.viewer.session import Session
from slipgym.rendering import palette
from slipgym.rendering.look import slips

SPEEDS = ("0.1x", "0.25x", "0.5x", "1x", "2x")
"""Seconds of simulation per second of watching."""
LATEST = 12
"""Largest latency of the slip sensors on offer [samples]."""
FRICTIONS, MASSES = (0.05, 1.5), (10.0, 1000.0)
"""Ranges of the sliders for mu_c [-] and the mass [g]."""
BY_HAND = "grip by hand"
_COLOURS = {
    "sticks": "#0072B2",
    "slips": "#D55E00",
    "success": "#009E73",
    "dropped": "#C0392B",
    "no success": "#767676",
}
_MARKS = (
    ("friction on the object", palette.FRICTION),
    ("grip force", palette.INK),
    ("push, support", PUSH),
    ("gravity", palette.MUTED),
    ("dashed: pose at the grasp", palette.SLIP),
    ("dashed: target", palette.TARGET),
)
_LEGEND = (
    '<div style="font-size:12px;line-height:1.4;padding:2px 8px;display:flex;flex-wrap:wrap;gap:0 12px">'
    + "".join(f'<span style="color:rgb{colour}"><b>&#9632;</b> {name}</span>' for name, colour in _MARKS)
    + "</div>"
)


class Controls:
    """The panel with the controls.

    Args:
        gui: `viser.ViserServer.gui`, inside the container that shall hold them.
        session: What they act on.
        names: Names of the policies on offer, the present one among them.
        record: Called with True to begin a video, with False to end it; it returns whether one is being made.
    """

    def __init__(
        self, gui: Any, session: Session, names: list[str], record: Callable[[bool], bool] | None = None
    ) -> None:
        self._session = session
        self.speed, self.paused = 1.0, False
        gripper = session.env.config.gripper

        def offer(handle: Any, label: str, take: Callable[[Any], Any]) -> Offer:
            return Offer(handle, label, take, session.refuse)

        def slider(label: str, low: float, high: float, step: float, value: float) -> Offer:
            take = number(low, high, isinstance(step, int))
            return offer(gui.add_slider(label, low, high, step, value), label, take)

        self._status = gui.add_html("")
        with gui.add_folder("acts at once"):
            hint = "The slider replaces the policy's grip."
            self._hand = offer(gui.add_checkbox(BY_HAND, False, hint=hint), BY_HAND, switch)
            self._range = gripper.force_min, gripper.force_max
            initial = session.env.settings.initial_force
            self._grip = slider("grip force [N]", *self._range, 0.1, initial)
            self._friction = slider("friction mu_c", *FRICTIONS, 0.01, 0.5)
            self._mass = slider("mass [g]", *MASSES, 5.0, 200.0)
            self._impulse = slider("poke [mN s]", 1.0, 100.0, 1.0, 10.0)
            self._pokes = [
                offer(gui.add_button_group(label, names), label, one_of(names))
                for label, names in (("push", PUSHES), ("turn", TURNS))
            ]
        with gui.add_folder("begins with the next episode"):
            menu = gui.add_dropdown("policy", names, initial_value=session.policy)
            self._policy = offer(menu, "policy", one_of(names))
            latency = min(session.env.config.sensors.slip.latency_samples, LATEST)
            self._latency = slider("latency [samples]", 0, LATEST, 1, latency)
            self._restart = gui.add_button("next episode", color="orange")
            self._free = gui.add_button("undo all sliders", color="gray")
        with gui.add_folder("play"):
            menu = gui.add_dropdown("speed", SPEEDS, initial_value="1x")
            self._speed = offer(menu, "speed", one_of(SPEEDS))
            self._pause = offer(gui.add_checkbox("pause", False), "pause", switch)
            box = gui.add_checkbox("record MP4", False) if record else None
            self._record = None if box is None else offer(box, "record MP4", switch)
        with gui.add_folder("in the picture"):
            gui.add_html(_LEGEND)
        self._connect(record)
        self.begin()

    def begin(self) -> None:
        """Show the values of an episode that was just reset, where none was set."""
        session, episode = self._session, self._session.env.simulation.episode[0]
        if "mu_c" not in session.values:
            self._friction.value = _within(round(float(episode["mu_c"]), 3), *FRICTIONS)
        if "mass" not in session.values:
            self._mass.value = _within(round(1e3 * float(episode["mass"]), 1), *MASSES)
        if "latency" not in session.values:
            self._latency.value = min(session.env.config.sensors.slip.latency_samples, LATEST)
        self._policy.value = session.policy
        self.update()

    def update(self) -> None:
        """Show how the episode goes, and the grip of the policy where no hand is on the slider."""
        session = self._session
        if not self._hand.value:
            grip = float(session.env.simulation.episode["command"][0])
            self._grip.value = round(_within(grip, *self._range), 1)
        self._status.content = status(session)

    def _connect(self, record: Callable[[bool], bool] | None) -> None:
        session = self._session
        self._hand.on_change(lambda on: session.submit("grip_force", self._grip.value if on else None))
        self._grip.on_change(self._take_over)
        self._friction.on_change(lambda value: session.submit("mu_c", value))
        self._mass.on_change(lambda value: session.submit("mass", 1e-3 * value))
        self._latency.on_change(lambda value: session.submit("latency", value))
        self._policy.on_change(lambda value: session.submit("policy", value))
        for group in self._pokes:
            group.on_click(lambda direction: session.poke(direction, 1e-3 * self._impulse.value))
        self._impulse.on_change(lambda _: None)  # it is checked now and acts with the next push
        self._restart.on_click(lambda _: session.request_restart())
        self._free.on_click(lambda _: self._undo())
        self._speed.on_change(lambda value: setattr(self, "speed", float(value.rstrip("x"))))
        self._pause.on_change(lambda value: setattr(self, "paused", value))
        if record is not None and self._record is not None:
            box = self._record
            box.on_change(lambda value: setattr(box, "value", record(value)))

    def _take_over(self, force: float) -> None:
        """The grip slider was moved: the hand acts from now on."""
        if not self._hand.value:
            self._hand.value = True
        self._session.submit("grip_force", force)

    def _undo(self) -> None:
        self._hand.value = False
        for name in ("grip_force", "mu_c", "mass", "latency"):
            self._session.submit(name, None)
        self._session.request_restart()


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def status(session: Session) -> str:
    """State of the episode as HTML: time, object, slip, friction and changes for the next one."""
    simulation, info = session.env.simulation, session.info
    state = session.outcome.ending if session.outcome else "slips" if slips(info["slip_twist"]) else "sticks"
    about = f"{simulation.materials[0]}, {1e3 * float(simulation.plant.world['mass'][0]):.0f} g"
    slip, true, estimated = info["slip"], info["true"], simulation.estimated[0]
    turn = round(math.degrees(slip[2]), 1) + 0.0  # no minus before a zero
    estimate = f"{estimated[1]:.3f} ± {estimated[7]:.3f}" if estimated[4] > 0.0 else "no data yet"
    rows = (
        ("policy", session.policy),
        ("object", about),
        ("slip", f"{1e3 * math.hypot(slip[0], slip[1]):.1f} mm, {turn:.1f}&deg;"),
        ("mu_c true", f"{true[1]:.3f}"),
        ("mu_c estimated", estimate if simulation.estimating else "no estimator"),
        ("set by hand", ", ".join(sorted(set(session.values) - session.pending)) or "nothing"),
        ("next episode", ", ".join(sorted(session.pending)) or "as this one"),
    )
    solved = sum(outcome.success for outcome in session.finished)
    cells = "".join(
        f'<tr><td style="color:#767676;padding-right:10px;white-space:nowrap">{name}</td>'
        f'<td data-name="{name}">{value if "&deg;" in value else html.escape(value)}</td></tr>'
        for name, value in rows
    )
    return (
        '<div style="font-size:13px;line-height:1.45;padding:4px 14px 4px 10px">'
        f'<b style="font-size:16px">{session.task.name}</b> '
        f'<span data-name="state" style="background:{_COLOURS[state]};color:white;border-radius:9px;'
        f'padding:1px 9px;margin:0 6px">{state}</span>'
        f'<span data-name="time" style="float:right;font-variant-numeric:tabular-nums">'
        f"{info['time']:.2f} s</span>"
        f'<div style="color:#767676">seed {session.seed}; {solved} of {len(session.finished)} solved</div>'
        f'<table style="border-spacing:0">{cells}</table></div>'
    )
