"""Plays a vector environment and records the resets and steps of each row."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from typing import Any, NamedTuple

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import concatenate, create_empty_array

from tests.vector_checker.compare import check_apart, demand, difference, spoil
from tests.vector_checker.returned import check_infos, check_numbers, check_observations, info_of

HOLD = 5
"""Steps for which an action is held."""


class Event(NamedTuple):
    """A reset or a step of a row, the same in every autoreset mode."""

    kind: str
    """"reset" or "step"."""
    observation: Any
    reward: float
    terminated: bool
    truncated: bool
    info: dict[str, Any]


class Player:
    """Plays the same sequence of actions in every row; steps that reset a row do not advance its sequence.

    Args:
        where: Name of the environment, for error messages.
        env: The environment.
        actions: Actions of one row, in turn.
        filler: Index of the action for rows that ignore it because they are reset.
        spoiling: Whether to overwrite all returned arrays after reading them.

    Attributes:
        events: Resets and steps of each row.
    """

    def __init__(
        self, where: str, env: VectorEnv, actions: Sequence[Any], filler: int = 0, spoiling: bool = False
    ) -> None:
        self._where, self._env, self._actions, self._filler = where, env, actions, filler
        self._spoiling = spoiling
        self._mode: Any = env.metadata["autoreset_mode"]
        n = env.num_envs
        self.events: list[list[Event]] = [[] for _ in range(n)]
        self._acted, self._over = [0] * n, np.zeros(n, dtype=bool)
        self._kept: list[tuple[str, Any, Any]] = []

    def reset(self, **arguments: Any) -> None:
        """Reset all rows, or those of options["reset_mask"]."""
        n, mask = self._env.num_envs, np.ones(self._env.num_envs, dtype=bool)
        if "options" in arguments:
            mask = arguments["options"]["reset_mask"].copy()
        where = f"{self._where}.reset()"
        observations, infos = self._take(where, self._env.reset(**arguments))
        rows = check_observations(where, self._env, observations)
        check_infos(where, n, infos, mask)
        for i in range(n):
            if mask[i]:
                self._began(i, rows[i], info_of(infos, i))
            else:
                unlike = difference(self.events[i][-1].observation, rows[i])
                demand(
                    not unlike, f"{where}: row {i} is not in the reset_mask, but its observation: {unlike}"
                )
        self._over[mask] = False

    def step(self, count: int = 1) -> None:
        """Make steps; rows whose episodes have ended are reset according to the autoreset mode."""
        for _ in range(count):
            self._step()

    def play(self, episodes: int, most: int) -> int:
        """Step until every row has begun more than a number of episodes, then twice more.

        Returns:
            Number of episodes that ended.
        """
        for _ in range(most):
            self._step()
            if min(self.begun(i) for i in range(self._env.num_envs)) > episodes:
                break
        self.step(2)
        return sum(event.terminated or event.truncated for events in self.events for event in events)

    def begun(self, i: int) -> int:
        """Number of episodes that row i has begun."""
        return sum(event.kind == "reset" for event in self.events[i])

    def _step(self) -> None:
        env, n, where = self._env, self._env.num_envs, f"{self._where}.step()"
        begins = self._over if self._mode is AutoresetMode.NEXT_STEP else np.zeros(n, dtype=bool)
        at = [self._filler if begins[i] else self._acted[i] for i in range(n)]
        chosen = [self._actions[k // HOLD % len(self._actions)] for k in at]
        batch: Any = create_empty_array(env.single_action_space, n)
        batch = concatenate(env.single_action_space, chosen, batch)
        said = self._take(where, env.step(batch))
        observations, rewards, terminated, truncated, infos = said
        rows = check_observations(where, env, observations)
        check_numbers(where, n, rewards, terminated, truncated)
        check_infos(where, n, infos, np.ones(n, dtype=bool))
        over = terminated | truncated
        finals = self._finals(where, over, infos)
        for i in range(n):
            info = info_of(infos, i)
            if begins[i]:
                quiet = rewards[i] == 0.0 and not over[i]
                demand(
                    quiet,
                    f"{where}: row {i} is reset in this step, so reward and flags must be 0, got {said[1:4]}",
                )
                self._began(i, rows[i], info)
                continue
            self._acted[i] += 1
            numbers = float(rewards[i]), bool(terminated[i]), bool(truncated[i])
            if i in finals:
                self.events[i].append(Event("step", finals[i][0], *numbers, finals[i][1]))
                kept = {key: value for key, value in info.items() if key not in ("final_obs", "final_info")}
                self._began(i, rows[i], kept)
            else:
                self.events[i].append(Event("step", rows[i], *numbers, info))
        self._over = over if self._mode is not AutoresetMode.SAME_STEP else np.zeros(n, dtype=bool)
        if self._mode is AutoresetMode.DISABLED and over.any():
            self.reset(options={"reset_mask": over.copy()})

    def _finals(self, where: str, over: np.ndarray, infos: dict[str, Any]) -> dict[int, tuple[Any, Any]]:
        """Last observations and infos of the episodes that ended, in the mode that returns them."""
        if self._mode is not AutoresetMode.SAME_STEP:
            return {}
        for key in ("final_obs", "final_info"):
            mask = infos.get(f"_{key}", np.zeros_like(over))
            wrong = np.flatnonzero(mask != over)
            demand(
                not len(wrong),
                f"{where}: infos['_{key}'] is {mask}, but the episodes {over} are over: row {wrong[:1]}",
            )
        finals = {}
        for i in np.flatnonzero(over).tolist():
            last = infos["final_obs"][i]
            fits = self._env.single_observation_space.contains(last)
            demand(fits, f"{where}: infos['final_obs'][{i}] is outside the space: {last}")
            finals[i] = last, info_of(infos["final_info"], i)
        return finals

    def _began(self, i: int, observation: Any, info: dict[str, Any]) -> None:
        self.events[i].append(Event("reset", observation, 0.0, False, False, info))

    def _take(self, where: str, said: Any) -> Any:
        """Copy the returned values; check that those of earlier calls have not changed."""
        for before, returned, copy in self._kept:
            unlike = difference(copy, returned)
            demand(not unlike, f"{where} changed what {before} had returned: {unlike}")
        copy = deepcopy(said)
        if self._spoiling:
            spoil(said)
        else:
            self._kept = [*self._kept[-2:], (where, said, copy)]
            if len(self.events[0]) < 2 or "final_obs" in said[-1]:
                check_apart(where, said)
        return copy
