"""Records an episode step by step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

INFOS = (
    "time", "slip", "reference", "grip_force", "contact_wrench", "true", "estimated_per_finger", "is_success",
    "dropped",
)  # fmt: skip
"""Entries of an info that are kept."""


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
    """Estimated mu_s, mu_c, r of each finger, (T, 2, 3) [-, -, m]; NaN where nothing estimates."""
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
    shown: np.ndarray | None = None
    """Friction mu_s and mu_c in the observations, (T, 2) [-]; NaN where they have none."""

    def series(self) -> dict[str, np.ndarray]:
        """The steps as columns, float32: a table with a row per step."""
        columns = {"time": self.time, "reference": self.reference[:, 0], "needed_force": self.needed_force}
        for k, axis in enumerate(("x", "y", "theta")):
            columns[f"slip_{axis}"] = self.slip[:, k]
        for finger in range(2):
            columns[f"force_{finger + 1}"] = self.grip_force[:, finger]
            for k, name in enumerate(("mu_s", "mu_c", "r")):
                columns[f"{name}_{finger + 1}"] = self.estimated[:, finger, k]
        shown = np.full((len(self.time), 2), np.nan) if self.shown is None else self.shown
        columns.update(shown_mu_s=shown[:, 0], shown_mu_c=shown[:, 1])
        return {name: values.astype(np.float32) for name, values in columns.items()}


class Recorder:
    """Collects the episodes of n environments, step by step.

    Args:
        columns: Names of the observation's columns.
        drawn: What the randomization drew for each environment, n mappings.
    """

    def __init__(self, columns: Sequence[str], drawn: Sequence[Mapping[str, Any]]) -> None:
        self._at = {name: k for k, name in enumerate(columns)}
        self._goal = next((name for name in ("distance", "angle") if name in self._at), "")
        self._drawn = drawn
        self._steps: list[dict[str, np.ndarray]] = []
        self._lengths = np.zeros(len(drawn), dtype=np.int64)

    def add(
        self, observations: np.ndarray, rewards: np.ndarray, infos: Mapping[str, Any], running: np.ndarray
    ) -> None:
        """Keeps what `step` returned, arrays with a leading axis of n.

        `running` says whether each environment's episode was still running before the step, (n,) bool.
        """
        kept = {"estimated_per_finger": np.full((len(rewards), 2, 3), np.nan), **infos}

        def column(name: str, otherwise: float) -> np.ndarray:
            return observations[:, self._at[name]] if name in self._at else np.full(len(rewards), otherwise)

        shown = np.stack([column(name, np.nan) for name in ("mu_s", "mu_c")], axis=1)
        own = {"reward": rewards, "goal": column(self._goal, 0.0), "shown": shown}
        self._steps.append({**own, **{name: kept[name] for name in INFOS}})
        self._lengths[running] = len(self._steps)

    def finish(self) -> list[Recording]:
        """The whole episodes, once all are over."""
        series = {name: np.array([step[name] for step in self._steps]) for name in self._steps[0]}
        return [self._recording(i, series) for i in range(len(self._drawn))]

    def _recording(self, i: int, series: Mapping[str, np.ndarray]) -> Recording:
        own = {name: values[: self._lengths[i], i].copy() for name, values in series.items()}
        last = {name: own[name][-1] for name in ("true", "goal", "is_success", "dropped")}
        return Recording(
            **{name: own[name] for name in ("time", "slip", "reference", "grip_force", "reward", "shown")},
            needed_force=needed_force(own["contact_wrench"], own["true"]),
            estimated=own["estimated_per_finger"],
            true=last["true"],
            goal=float(last["goal"]),
            success=bool(last["is_success"]),
            dropped=bool(last["dropped"]),
            drawn=self._drawn[i],
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
