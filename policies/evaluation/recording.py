"""What is kept of an episode, step by step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from policies.controllers.base import ObservationIndex


@dataclass(frozen=True)
class Recording:
    """T steps of an episode; every row is the state after a step."""

    time: np.ndarray
    """Since reset, (T,) [s]."""
    slip: np.ndarray
    """True slip (x, y, theta), (T, 3) [m, m, rad]; gravity pulls along -y and turns along -theta."""
    reference: np.ndarray
    """Position, velocity, acceleration the task asks for, (T, 3) [m or rad, per s, per s^2]; in Hinge those
    of the wrist's pitch, in PlanarSlip the target (x, y, theta) [m, m, rad]."""
    grip_force: np.ndarray
    """Of each finger, (T, 2) [N]."""
    needed_force: np.ndarray
    """Least grip force per finger that can carry the load, (T,) [N]."""
    estimated: np.ndarray
    """Estimated mu_s, mu_c, r of each finger, (T, 2, 3) [-, -, m]."""
    true: np.ndarray
    """True mu_s, mu_c, r at the end, (3,) [-, -, m]."""
    reward: np.ndarray
    """Reward of each step, (T,)."""
    goal: float
    """Distance to slide [m] or angle to turn [rad]; 0 where the task has neither."""
    success: bool
    """Whether the task succeeded."""
    dropped: bool
    """Whether the object was lost."""
    drawn: Mapping[str, Any]
    """What the randomization drew; empty without one."""

    def series(self) -> dict[str, np.ndarray]:
        """The steps as columns, float32: a table with a row per step."""
        columns = {"time": self.time, "reference": self.reference[:, 0], "needed_force": self.needed_force}
        for k, axis in enumerate(("x", "y", "theta")):
            columns[f"slip_{axis}"] = self.slip[:, k]
        for finger in range(2):
            columns[f"force_{finger + 1}"] = self.grip_force[:, finger]
            for k, name in enumerate(("mu_s", "mu_c", "r")):
                columns[f"{name}_{finger + 1}"] = self.estimated[:, finger, k]
        return {name: values.astype(np.float32) for name, values in columns.items()}


class Recorder:
    """Collects an episode.

    Args:
        index: Where the columns of the observation are.
    """

    def __init__(self, index: ObservationIndex) -> None:
        goals = (index.get(name) for name in ("distance", "angle"))
        self._goal = next((goal for goal in goals if goal is not None), None)
        self._drawn: Mapping[str, Any] = {}
        self._steps: list[tuple[np.ndarray, float, Mapping[str, Any]]] = []

    def begin(self, info: Mapping[str, Any]) -> None:
        """Keeps what `reset` said."""
        self._drawn = info.get("drawn", {})

    def add(self, observation: np.ndarray, reward: float, info: Mapping[str, Any]) -> None:
        """Keeps what `step` returned."""
        self._steps.append((observation, reward, info))

    def finish(self) -> Recording:
        """The whole episode, once it is over."""
        observations, rewards, infos = zip(*self._steps, strict=True)
        last = infos[-1]
        wrenches = np.array([info["contact_wrench"] for info in infos])
        true = np.array([info["true"] for info in infos])
        return Recording(
            time=np.array([info["time"] for info in infos]),
            slip=np.array([info["slip"] for info in infos]),
            reference=np.array([info["reference"] for info in infos]),
            grip_force=np.array([info["grip_force"] for info in infos]),
            needed_force=needed_force(wrenches, true),
            estimated=np.array([info["estimated_per_finger"] for info in infos]),
            true=last["true"],
            reward=np.array(rewards),
            goal=0.0 if self._goal is None else float(observations[-1][self._goal]),
            success=last["is_success"],
            dropped=last["dropped"],
            drawn=self._drawn,
        )


def needed_force(wrenches: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Least normal force per finger that keeps both pads stuck under a load (ellipsoid limit surface).

    While the pads slip, friction carries no more than mu_c f_n: then this is below the force that
    would stop the slip.

    Args:
        wrenches: True friction (f_x, f_y, tau) of both fingers, (T, 2, 3) [N, N, N m].
        true: True mu_s, mu_c, r, (T, 3) [-, -, m].

    Returns:
        sqrt(f_x^2 + f_y^2 + (tau / r)^2) / mu_s of the fingers' mean load, (T,) [N].
    """
    load = wrenches.mean(axis=1)
    load[:, 2] /= true[:, 2]
    return np.linalg.norm(load, axis=1) / true[:, 0]
