"""What an environment observes: layout, history and groups."""

from __future__ import annotations

from typing import TypeAlias

import gymnasium as gym
import numpy as np

from slipgym.envs import privileged
from slipgym.envs.choices import one_of, whole
from slipgym.envs.loop import SlipLoop
from slipgym.envs.observation import (
    FRICTION_SOURCES,
    OBSERVATION_MODES,
    WRIST_COLUMNS,
    columns,
    observe,
    wrist_columns,
)
from slipgym.tasks.task import Column

Observation: TypeAlias = np.ndarray | dict[str, np.ndarray]
"""An array, or one per group."""


class Observer:
    """Reads the observation out of a loop.

    Args:
        loop: What is observed.
        friction_source: What the friction part holds.
        action_mode: What actions mean; decides about the wrist part.
        mode: "flat", "sensor" or "dict".
        history: How many earlier observations come along.

    Attributes:
        columns: Of one observation, or of its group "policy".
        privileged: Columns of the group "privileged"; empty without one.
        space: The observation space.
        friction: Friction part, (1, 6).
        frames: The last observations (history + 1, m) float32, the present one last.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
    """

    def __init__(
        self, loop: SlipLoop, friction_source: str, action_mode: str, mode: str, history: int
    ) -> None:
        one_of("friction_source", friction_source, FRICTION_SOURCES)
        one_of("observation_mode", mode, OBSERVATION_MODES)
        self._loop, self._source = loop, friction_source
        self._history = whole("history", history, 0)
        self.columns = columns(loop.config, loop.task, friction_source, action_mode, mode)
        wrist = wrist_columns(loop.task, action_mode)
        self.frames = np.zeros((history + 1, len(self.columns)), dtype=np.float32)
        # the friction part: the merged estimates, or values that stand for the episode
        self.friction = loop.estimated if friction_source == "estimated" else np.ones((1, 6))
        self._sources = (
            loop.wrenches,
            loop.twists,
            loop.plant.chips,
            loop.episode,
            loop.task_part,
            loop.plant.world,
            np.array([WRIST_COLUMNS.index(column) for column in wrist], dtype=np.int64),
            self.friction,
            *_bounds(self.columns),
            self.frames[-1:],
        )
        low, high = self._sources[-3:-1]
        policy = gym.spaces.Box(np.tile(low, history + 1), np.tile(high, history + 1))
        self.privileged: tuple[Column, ...] = ()
        self.space: gym.Space = policy
        if mode == "dict":
            self.privileged = privileged.columns(loop.config)
            self._truth_bounds = _bounds(self.privileged)
            self._truth = np.zeros((1, len(self.privileged)), dtype=np.float32)
            truth = gym.spaces.Box(*self._truth_bounds)
            self.space = gym.spaces.Dict({"policy": policy, "privileged": truth})

    def begin(self) -> Observation:
        """The first observation of an episode; it stands for those before it, too."""
        loop = self._loop
        if self._source == "true":
            self.friction[0, :3] = loop.true_friction
        elif self._source == "nominal":
            nominal = loop.config.nominal
            radius = getattr(loop.config.tasks, loop.task.key).radius or nominal.r
            self.friction[0, :3] = nominal.mu_s, nominal.mu_c, radius
        observe(*self._sources)
        self.frames[:-1] = self.frames[-1]
        return self._read()

    def next(self) -> Observation:
        """The observation after a step."""
        if self._history:
            self.frames[:-1] = self.frames[1:]
        observe(*self._sources)
        return self._read()

    def _read(self) -> Observation:
        policy = self.frames.flatten()
        if not self.privileged:
            return policy
        plant, (low, high) = self._loop.plant, self._truth_bounds
        truth = self._loop.true_friction[np.newaxis]
        privileged.reveal(plant.world, plant.pads, plant.fingers, truth, low, high, self._truth)
        return {"policy": policy, "privileged": self._truth[0].copy()}


def _bounds(named: tuple[Column, ...]) -> tuple[np.ndarray, np.ndarray]:
    low, high = ([getattr(column, end) for column in named] for end in ("low", "high"))
    return np.array(low, dtype=np.float32), np.array(high, dtype=np.float32)
