"""Checks a vector environment against Gymnasium's conventions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import closing
from copy import deepcopy
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

from tests.vector_checker.compare import demand, difference
from tests.vector_checker.player import HOLD, Event, Player
from tests.vector_checker.returned import check_attributes

Make = Callable[[int, AutoresetMode | None], VectorEnv]
_REFUSED = (TypeError, ValueError, AssertionError, gym.error.Error)
_SEEDS = (11, 5, 8)


def check_vector_env(
    make: Make,
    modes: Iterable[AutoresetMode | None] = tuple(AutoresetMode),
    episodes: int = 2,
    steps: int = 1000,
) -> None:
    """Check that a vector environment follows Gymnasium's conventions.

    The checks cover spaces, shapes and types; infos and their masks; that returned arrays share no memory;
    autoreset modes that behave as in `gymnasium.vector.SyncVectorEnv`; seeds; determinism, including infos;
    and closing. Optional features are checked if the environment has them: if `reset` takes a list of seeds,
    a row must depend on its seed and its actions alone, in every mode and for any number of environments.

    Args:
        make: Makes an environment from a number of environments and an autoreset mode (None: its own).
        modes: Modes to check.
        episodes: Number of episodes of every row in a rollout, if `steps` suffice.
        steps: Largest number of steps of a rollout.

    Raises:
        AssertionError: The environment violates a convention; the message names mode, call, row and key.
        ValueError: No episode ends within `steps`, so that autoreset cannot be checked.
    """
    rollouts: dict[str, list[list[Event]]] = {}
    for mode in modes:
        checker = _Checker(make, mode, episodes, steps)
        checker.check()
        if checker.by_row:
            rollouts[checker.name] = checker.events
    names = list(rollouts)
    for name in names[1:]:
        _compare(f"{names[0]} and {name}, with equal seeds and actions", rollouts[names[0]], rollouts[name])


class _Checker:
    """Checks of one mode."""

    def __init__(self, make: Make, mode: AutoresetMode | None, episodes: int, steps: int) -> None:
        self._make, self._mode, self._episodes, self._steps = make, mode, episodes, steps
        self.name = mode.value if mode else "own mode"
        with closing(self._new()) as env:
            space = deepcopy(env.single_action_space)
            self._where = f"{type(env.unwrapped).__name__} ({self.name})"
            self._own = check_attributes(self._where, env, 3, mode)
            self.by_row = _takes_a_list(env)
        space.seed(0)
        self._actions = [space.sample() for _ in range(steps)]

    def check(self) -> None:
        with closing(self._new()) as env:
            player = Player(self._where, env, self._actions)
            player.reset(seed=_SEEDS[0])
            ended = player.play(self._episodes, self._steps)
            if not ended:
                raise ValueError(f"{self._where}: no episode ends within {self._steps} steps")
            self.events = player.events
            self._same("the same environment, reset with the same seed", self._events(env))
        self._same("another environment with the same seed", self._events())
        self._same("one whose returned arrays were overwritten", self._events(spoiling=True))
        if self._own is AutoresetMode.NEXT_STEP:
            other = next((k for k, a in enumerate(self._actions) if difference(a, self._actions[0])), 0)
            self._same("one with other actions in the steps that reset", self._events(filler=other * HOLD))
        self._check_seeds()
        if self._own is AutoresetMode.DISABLED:
            self._check_masks()
        with closing(self._new()) as env:
            env.reset(seed=0)
            env.close()

    def _check_seeds(self) -> None:
        other = self._events(seed=_SEEDS[1], least=True)
        demand(_unlike(other, self.events), f"{self._where}: seeds {_SEEDS[:2]} give equal episodes")
        demand(
            difference(self.events[0], self.events[1]),
            f"{self._where}: rows 0 and 1 are equal after reset(seed={_SEEDS[0]})",
        )
        again = [self._again() for _ in range(2)]
        _compare(f"{self._where}: two environments after reset(seed) and reset()", *again)
        for i, events in enumerate(again[0]):
            demand(
                difference(events[0].observation, events[1].observation)
                or difference(events[0].info, events[1].info),
                f"{self._where}: reset() without a seed repeats the episode of row {i}",
            )
        if not self.by_row:
            return
        counted = [_SEEDS[0] + i for i in range(3)]
        self._same(f"one reset with the seeds {counted}", self._events(seed=counted, least=True))
        mixed = self._events(seed=counted[::-1], least=True)[::-1]
        self._same(f"the rows of one reset with the seeds {counted[::-1]}, in reverse", mixed)
        for i, seed in enumerate(counted):
            alone = self._events(seed=seed, n=1)
            _compare(
                f"{self._where}: row {i} and one environment with its seed {seed}",
                self.events[i : i + 1],
                alone,
            )

    def _check_masks(self) -> None:
        for mask, what in (
            (np.zeros(3, dtype=bool), "without a True"),
            (np.ones(4, dtype=bool), "of another length"),
            (np.ones(3), "of floats"),
        ):
            with closing(self._new()) as env:
                env.reset(seed=0)
                try:
                    env.reset(options={"reset_mask": mask})
                except _REFUSED:
                    continue
            raise AssertionError(f"{self._where}: reset() takes a reset_mask {what}")
        if not self.by_row:
            return
        with closing(self._new()) as env:
            player = Player(self._where, env, self._actions)
            player.reset(seed=_SEEDS[0])
            player.step(3)
            before = len(player.events[1])
            player.reset(seed=[1, 2, 3], options={"reset_mask": np.array([False, True, False])})
            player.step(10)
        rest = [player.events[0], self.events[1], player.events[2]]
        self._same("rows 0 and 2 of one whose row 1 was reset by a mask", rest)
        fresh = self._events(seed=2, n=1, least=True)
        # the actions of the two go on differently, so the reset alone is compared
        masked = player.events[1][before : before + 1]
        _compare(f"{self._where}: row 1 reset by a mask with seed 2", [masked], [fresh[0][:1]])

    def _events(
        self, env: VectorEnv | None = None, seed: Any = _SEEDS[0], n: int = 3, least: bool = False, **how: Any
    ) -> list[list[Event]]:
        """A rollout; `least`: a short one."""
        if env is None:
            with closing(self._new(n)) as own:
                return self._events(own, seed, n, least, **how)
        player = Player(self._where, env, self._actions, **how)
        player.reset(seed=seed)
        player.play(0 if least else self._episodes, 1 if least else self._steps)
        return player.events

    def _again(self) -> list[list[Event]]:
        """Two resets, the second without a seed."""
        with closing(self._new()) as env:
            player = Player(self._where, env, self._actions)
            player.reset(seed=_SEEDS[0])
            player.reset()
            player.step(3)
            return player.events

    def _same(self, what: str, events: list[list[Event]]) -> None:
        _compare(f"{self._where}: a rollout and {what}", self.events, events)

    def _new(self, n: int = 3) -> VectorEnv:
        return self._make(n, self._mode)


def _takes_a_list(env: VectorEnv) -> bool:
    try:
        env.reset(seed=list(range(env.num_envs)))  # pyright: ignore[reportArgumentType]
    except _REFUSED:
        return False
    return True


def _unlike(a: list[list[Event]], b: list[list[Event]]) -> str | None:
    """The first difference of two rollouts, as far as both go."""
    for i, (one, other) in enumerate(zip(a, b, strict=True)):
        for k, (here, there) in enumerate(zip(one, other, strict=False)):
            for name, x, y in zip(Event._fields, here, there, strict=True):
                if unlike := difference(x, y):
                    return f"row {i}, event {k} ({here.kind}), {name}{unlike}"
    return None


def _compare(what: str, a: list[list[Event]], b: list[list[Event]]) -> None:
    unlike = _unlike(a, b)
    demand(not unlike, f"{what}, differ: {unlike}")
