"""The viewer: a server for the browser, and the loop that plays the episodes in real time."""

from __future__ import annotations

import logging
import os
import socket
import time
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import policies
from policies.controllers import table as controllers
from policies.learned import LearnedPolicy
from policies.play.video import Recording
from policies.play.viewer.controls import Controls
from policies.play.viewer.guard import guard
from policies.play.viewer.plots import Plots
from policies.play.viewer.scene import Scene
from policies.play.viewer.session import Refused, Session
from policies.play.watch import environment
from slipgym.atomic_io import check_file
from slipgym.tasks import Task

FRAME_RATE, PLOT_RATE = 30.0, 8.0
"""Updates of the 3-D view and of the plots per second of watching."""
PAUSE = 1.5
"""Time that the end of an episode stays in view [s]."""
MISSING = "the viewer needs viser: pip install 'slipgym[viewer]'"


class Viewer:
    """A session in a browser; arguments and errors are those of `open_viewer`."""

    def __init__(
        self,
        session: Session,
        video: str | os.PathLike[str] = "slipgym.mp4",
        port: int = 8080,
        host: str = "127.0.0.1",
    ) -> None:
        viser = _viser()
        self.session, self.recording = session, Recording(video)
        self._wanted, self._trouble = False, ""
        self.server = viser.ViserServer(host, port, label=f"slipgym {session.task.name}", verbose=False)
        guard(self.server, host)
        gui = self.server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, brand_color=(0, 114, 178))
        self.scene = Scene(self.server.scene, self.server.initial_camera)
        gui.main_panel.dock_left()
        gui.main_panel.set_width(300)
        names = dict.fromkeys([session.policy, *policies_for(session.task, session.keywords)])
        self.controls = Controls(gui, session, [*names], lambda wanted: setattr(self, "_wanted", wanted))
        panel = gui.add_panel()
        with panel.add_tab("plots"):
            self.plots = Plots(gui, session)
        panel.dock_right()
        panel.set_width(400)
        self._history, self._ended, self._plotted = session.history, 0.0, 0.0
        self.scene.begin(session.env.simulation)

    @property
    def url(self) -> str:
        """Address for a browser."""
        return f"http://{self.server.get_host()}:{self.server.get_port()}"

    def frame(self, seconds: float) -> None:
        """Play a stretch of watching time [s] and show what it leads to; no error ends the server."""
        try:
            self._play(seconds)
        except Refused as error:
            self._say("not possible", str(error), "red")
        except Exception as error:  # of a policy, or of a value that the environment cannot bear
            self._failed("the episode cannot go on", error)
            self.session.give_up()
            self._ended = 0.0
        try:
            self._record(seconds)
        except Exception as error:  # a full disk, a picture that cannot be drawn
            self._wanted = False
            self._failed("no recording", error)
        try:
            self._show(seconds)
            self._trouble = ""
        except Exception as error:
            if str(error) != self._trouble:  # once, not with each of the frames that follow
                self._trouble = str(error)
                self._failed("the page cannot be drawn", error)

    def _play(self, seconds: float) -> None:
        session, controls = self.session, self.controls
        session.advance(0.0 if controls.paused else seconds * controls.speed)
        over = session.failed or session.outcome is not None
        self._ended = self._ended + seconds if over and not controls.paused else 0.0
        if self._ended >= PAUSE:
            self._ended = 0.0
            session.restart()

    def _show(self, seconds: float) -> None:
        session = self.session
        with self.server.atomic():
            if session.history is not self._history:
                self._history, self._ended = session.history, 0.0
                self.scene.begin(session.env.simulation)
                self.plots.begin()
                self.controls.begin()
            self.scene.update(session.env.simulation)
            self._plotted += seconds
            if self._plotted >= 1.0 / PLOT_RATE:
                self._plotted = 0.0
                self.plots.update()
                self.controls.update()

    def run(self, keep_on: Callable[[], bool] = lambda: True) -> None:
        """Play in real time until `keep_on` returns False."""
        last = time.monotonic()
        while keep_on():
            time.sleep(max(0.0, last + 1.0 / FRAME_RATE - time.monotonic()))
            now = time.monotonic()
            self.frame(now - last)
            last = now

    def close(self) -> None:
        """Complete a recording, stop the server and close the environment."""
        self.recording.end()
        self.server.stop()
        self.session.close()

    def _record(self, seconds: float) -> None:
        """Begin, continue or end a recording, in the thread of the environment."""
        recording = self.recording
        if self._wanted and not recording.running:
            try:
                recording.begin()
            except (OSError, ImportError) as error:
                self._wanted = False
                self._say("no recording", str(error), "red")
        if recording.running and self._wanted:
            recording.add(self.session.env, seconds)
        elif path := recording.end():
            self._say("recorded", str(path.resolve()), "green")

    def _failed(self, title: str, error: Exception) -> None:
        """Name an error on the page, and with its origin on the terminal."""
        logging.getLogger(__name__).error(title, exc_info=error)
        self._say(title, f"{type(error).__name__}: {error}", "red")

    def _say(self, title: str, words: str, colour: str) -> None:
        for client in self.server.get_clients().values():
            client.add_notification(title, words, color=colour, auto_close_seconds=8.0)


def _viser() -> Any:
    """The package, which the extra "viewer" installs."""
    try:
        return import_module("viser")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(MISSING) from error


def policies_for(task: Task, keywords: Mapping[str, Any]) -> list[str]:
    """Names of the task's controllers and learned policies that can act in such an environment."""

    def fits(name: str) -> bool:
        policy = policies.load(name)
        if isinstance(policy, LearnedPolicy):
            meant = policy.description.environment.id == task.id
        else:
            meant = controllers.find(name).task in (None, task.name)
        if not meant:
            return False
        try:
            environment(task.id, name, policy, keywords).close()
        except ValueError:
            return False
        return True

    return [*filter(fits, policies.names())]


def open_viewer(
    task: str,
    policy: str | os.PathLike[str] | None = None,
    video: str | os.PathLike[str] | None = None,
    seed: int = 0,
    options: Mapping[str, Any] | None = None,
    port: int = 8080,
    host: str = "127.0.0.1",
    **keywords: Any,
) -> Viewer:
    """Make an environment, a policy and a viewer of both; `run` plays it.

    Args:
        task: As `slipgym.tasks.find` takes it.
        policy: A name of `policies.names()`, "module:class" or the folder of a learned policy; None for the
            task's own.
        video: MP4 or GIF for recordings; None: slipgym_<task>.mp4 in the working directory.
        seed: Of the first episode; the others' follow.
        options: Of every reset.
        port: Of the server; the next free one if it is taken.
        host: Address that the server listens on. Whoever opens its page there can move the sliders.
        **keywords: Of the environment.

    Raises:
        ModuleNotFoundError: viser or the engine is not installed.
        RuntimeError: This version of viser does not let pages be checked.
        ValueError: A value is unknown or not allowed.
        FileNotFoundError: There is no policy at the path.
        OSError: The video cannot be written, or the host is no address of this machine.
    """
    _viser()
    if not 0 <= port <= 65535:
        raise ValueError(f"port = {port!r} must lie in 0 to 65535")
    family, *_, address = socket.getaddrinfo(host, 0, type=socket.SOCK_STREAM)[0]
    with socket.socket(family) as attempt:
        attempt.bind(address)  # viser would try for ever
    if video is not None:
        check_file(Path(video))
    session = Session(task, policy, seed, options, **keywords)
    try:
        return Viewer(session, video or f"slipgym_{session.task.key}.mp4", port, host)
    except BaseException:
        session.close()
        raise
