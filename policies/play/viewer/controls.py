"""Sliders, buttons and menus of the viewer, and the line that says how the episode goes."""

from __future__ import annotations

import html
import math
from collections.abc import Callable
from functools import partial
from typing import Any

from policies.play.viewer.guard import Offer, number, one_of, switch
from policies.play.viewer.interventions import PUSHES, TURNS
from policies.play.viewer.scene import PUSH
from policies.play.viewer.session import Session
from slipgym.rendering import palette
from slipgym.rendering.look import about, moves

SPEEDS = ("0.1x", "0.25x", "0.5x", "1x", "2x")
"""Seconds of simulation per second of watching."""
LATEST = 12
"""Largest latency of the slip sensors on offer [samples]."""
FRICTIONS, MASSES = (0.05, 1.5), (10.0, 1000.0)
"""Ranges of the sliders for mu_c [-] and the mass [g]."""
BY_HAND = "grip by hand"
_COLOURS = {"sticks": "#0072B2", "slips": "#D55E00", "success": "#009E73", "dropped": "#C0392B"}
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
    """The panel with the controls of a session, in the container of `viser.ViserServer.gui` that is open.

    The names are those of the policies on offer, the present one among them. `record` is called with True to
    begin a video, with False to end it.
    """

    def __init__(
        self, gui: Any, session: Session, names: list[str], record: Callable[[bool], None] | None = None
    ) -> None:
        self._session = session
        self.speed, self.paused = 1.0, False
        gripper, submit = session.env.config.gripper, session.submit

        def offer(handle: Any, label: str, take: Callable[[Any], Any], act: Callable[[Any], Any]) -> Offer:
            made = Offer(handle, label, take, session.refuse)
            made.on_change(act)
            return made

        def slider(label: str, low: float, high: float, step: float, value: float, act: Any) -> Offer:
            take = number(low, high, isinstance(step, int))
            return offer(gui.add_slider(label, low, high, step, value), label, take, act)

        self._status = gui.add_html("")
        with gui.add_folder("acts at once"):
            hint = "The slider replaces the policy's grip."
            box = gui.add_checkbox(BY_HAND, False, hint=hint)
            hold = partial(submit, "grip_force")
            self._hand = offer(box, BY_HAND, switch, lambda on: hold(self._grip.value if on else None))
            self._range = gripper.force_min, gripper.force_max
            initial = session.env.settings.initial_force
            self._grip = slider("grip force [N]", *self._range, 0.1, initial, self._take_over)
            self._friction = slider("friction mu_c", *FRICTIONS, 0.01, 0.5, partial(submit, "mu_c"))
            self._mass = slider("mass [g]", *MASSES, 5.0, 200.0, lambda grams: submit("mass", 1e-3 * grams))
            impulse = slider("poke [mN s]", 1.0, 100.0, 1.0, 10.0, lambda _: None)  # acts with the next push
            for label, ways in (("push", PUSHES), ("turn", TURNS)):
                group = Offer(gui.add_button_group(label, ways), label, one_of(ways), session.refuse)
                group.on_click(lambda way: session.poke(way, 1e-3 * impulse.value))
        with gui.add_folder("begins with the next episode"):
            menu = gui.add_dropdown("policy", names, initial_value=session.policy)
            self._policy = offer(menu, "policy", one_of(names), partial(submit, "policy"))
            latency = partial(submit, "latency")
            self._latency = slider("latency [samples]", 0, LATEST, 1, self._samples, latency)
            restart = gui.add_button("next episode", color="orange")
            restart.on_click(lambda _: session.request_restart())
            gui.add_button("undo all sliders", color="gray").on_click(lambda _: self._undo())
        with gui.add_folder("play"):
            menu = gui.add_dropdown("speed", SPEEDS, initial_value="1x")
            offer(menu, "speed", one_of(SPEEDS), lambda v: setattr(self, "speed", float(v.rstrip("x"))))
            box = gui.add_checkbox("pause", False)
            offer(box, "pause", switch, lambda on: setattr(self, "paused", on))
            if record is not None:
                box = gui.add_checkbox("record MP4", False)
                offer(box, "record MP4", switch, record)
        with gui.add_folder("in the picture"):
            gui.add_html(_LEGEND)
        self.begin()

    def begin(self) -> None:
        """Show the values of an episode that was just reset, where none was set."""
        session, episode = self._session, self._session.env.simulation.episode[0]
        if "mu_c" not in session.values:
            self._friction.value = _within(round(float(episode["mu_c"]), 3), *FRICTIONS)
        if "mass" not in session.values:
            self._mass.value = _within(round(1e3 * float(episode["mass"]), 1), *MASSES)
        if "latency" not in session.values:
            self._latency.value = self._samples
        self._policy.value = session.policy
        self.update()

    def update(self) -> None:
        """Show how the episode goes, and the grip of the policy where no hand is on the slider."""
        session = self._session
        if not self._hand.value:
            grip = float(session.env.simulation.episode["command"][0])
            self._grip.value = round(_within(grip, *self._range), 1)
        self._status.content = status(session)

    @property
    def _samples(self) -> int:
        return min(self._session.env.config.sensors.slip.latency_samples, LATEST)

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
    state = session.outcome.ending if session.outcome else moves(simulation, 0)
    slip, true, estimated = info["slip"], info["true"], simulation.estimated[0]
    turn = round(math.degrees(slip[2]), 1) + 0.0  # no minus before a zero
    estimate = f"{estimated[1]:.3f} ± {estimated[7]:.3f}" if estimated[4] > 0.0 else "no data yet"
    rows = (
        ("policy", session.policy),
        ("object", about(simulation, 0)),
        ("slip", f"{1e3 * math.hypot(slip[0], slip[1]):.1f} mm, {turn:.1f}&deg;"),
        ("mu_c true", f"{true[1]:.3f}"),
        ("mu_c estimated", estimate if simulation.estimating else "no estimator"),
        ("set by hand", ", ".join(sorted(set(session.values) - session.pending)) or "nothing"),
        ("next episode", ", ".join(sorted(session.pending)) or "as this one"),
    )
    solved, colour = sum(outcome.success for outcome in session.finished), _COLOURS.get(state, "#767676")
    cells = "".join(
        f'<tr><td style="color:#767676;padding-right:10px;white-space:nowrap">{name}</td>'
        f'<td data-name="{name}">{value if "&deg;" in value else html.escape(value)}</td></tr>'
        for name, value in rows
    )
    return (
        '<div style="font-size:13px;line-height:1.45;padding:4px 14px 4px 10px">'
        f'<b style="font-size:16px">{session.task.name}</b> '
        f'<span data-name="state" style="background:{colour};color:white;border-radius:9px;'
        f'padding:1px 9px;margin:0 6px">{state}</span>'
        f'<span data-name="time" style="float:right;font-variant-numeric:tabular-nums">'
        f"{info['time']:.2f} s</span>"
        f'<div style="color:#767676">seed {session.seed}; {solved} of {len(session.finished)} solved</div>'
        f'<table style="border-spacing:0">{cells}</table></div>'
    )
