"""Renders an environment: the view of the gripper, text over it, and plots beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from slipgym.rendering.camera import Camera, arrange, framing
from slipgym.rendering.discrepancy import Discrepancy, discrepancies
from slipgym.rendering.history import History
from slipgym.rendering.look import View, about, feel, look, moves
from slipgym.rendering.plot import draw_strip
from slipgym.rendering.scene import draw_scene, measure_depth
from slipgym.rendering.stage import footprint
from slipgym.rendering.text import caption
from slipgym.screen import Window

if TYPE_CHECKING:
    from slipgym.envs.simulation import Simulation

WINDOW_RATE = 30
"""Pictures per second in a window."""


class Renderer:
    """Renders an environment of a simulation, without changing it.

    Args:
        mode: "rgb_array", "depth_array" or "human".
        simulation: The environment's simulation.
        row: Index of the environment.
        size: Width and height of the pictures [pixels]; None: see `slipgym.rendering.camera.arrange`.
    """

    def __init__(
        self, mode: str, simulation: Simulation, row: int = 0, size: Sequence[int] | None = None
    ) -> None:
        self._mode, self._simulation, self._row = mode, simulation, row
        self._motion, self._layout = simulation.task.motion, arrange(mode, size)
        self._window: Window | None = None
        if mode == "human":
            shape = self._layout.width + self._layout.strip, self._layout.height
            self._window = Window(f"slipgym {simulation.task.name}", shape)

    def begin(self) -> None:
        """Start the plots anew, after a reset or a restored state."""
        self._history = History(self._simulation, self._row, self._motion)
        names = [column.name for column in self._simulation.task.columns]
        goals = dict(zip(names, self._simulation.task_part[self._row].tolist(), strict=True))
        self._goal = self._motion.target(goals.get(self._motion.goal, 0.0))
        episode = self._simulation.episode[self._row]
        turns = [goals.get("wrist_pitch_goal", 0.0), *np.cumsum(episode["moves"][:, 4]).tolist()]
        self._start = episode["wrist_start"].copy()
        target = self._motion.pose(episode)
        self._framed = framing(footprint(self._view(), self._start.tolist(), target, turns), self._layout)
        self._show()

    def keep(self) -> None:
        """Record the present control step for the plots; update the window `WINDOW_RATE` times a second."""
        self._history.keep()
        every = max(1, round(1.0 / (WINDOW_RATE * self._history.step_time)))
        if self._history.step % every == 0:
            self._show()

    def render(self) -> np.ndarray | None:
        """Return a picture (height, width, 3) uint8 or depths, or show the window and return None."""
        if self._mode == "depth_array":
            return measure_depth(self._view(), self._camera)
        if self._mode == "rgb_array":
            return self.picture()
        self._show()
        return None

    def picture(self) -> np.ndarray:
        """Return a new picture (height, width, 3) uint8."""
        simulation, row = self._simulation, self._row
        contact, episode = feel(simulation, row), simulation.episode[row]
        target = self._motion.pose(episode)
        view = draw_scene(self._view(), contact, self._camera, target)
        if not self._layout.strip:
            return np.array(view)
        state = "dropped" if episode["dropped"] else "success" if episode["success"] else ""
        corners = simulation.task.name, about(simulation, row), f"{self._history.time:.2f} s"
        words = *corners, state or moves(simulation, row)
        slip = simulation.plant.world["slip"][row]
        caption(view, words, contact, slip, target is not None, self._layout.scale)
        off = self.discrepancies()
        beside = draw_strip(self._history, self._motion, self._goal, off, self._layout)
        return np.hstack([np.asarray(view), np.asarray(beside)])

    def discrepancies(self) -> list[Discrepancy]:
        """Return the estimates that are off, or have no data, as a picture names them."""
        return discrepancies(self._simulation, self._row, self._history)

    @property
    def _camera(self) -> Camera:
        """The camera, which follows the gripper."""
        wrist = self._simulation.plant.world["wrist"][self._row]
        return self._framed.follow(wrist[:2] - self._start[:2])

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()

    def _show(self) -> None:
        if self._window is not None:
            self._window.show(self.picture(), WINDOW_RATE)

    def _view(self) -> View:
        return look(self._simulation, self._row)
