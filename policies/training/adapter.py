"""Stable-Baselines3 on a batch of environments that one compiled call steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.vec_env import VecEnv, VecMonitor, VecNormalize
from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn

from slipgym.envs.vector_env import SlipVectorEnv
from slipgym.tasks import find

_AUTORESET = {False: AutoresetMode.SAME_STEP, True: AutoresetMode.DISABLED}
"""Whether there are scenarios -> the mode that a batch needs."""
_GOLDEN = (5.0**0.5 - 1.0) / 2.0
"""Multiples of it, modulo 1, are spread evenly over the unit interval, however many they are."""
_OF_ONE = {"action_space": "single_action_space", "observation_space": "single_observation_space"}


class TaskEnd(gym.Wrapper):
    """An environment that terminates at its task's own end, where no reward follows.

    Environments report that end as a truncation, and learners take a truncation for a cut in an episode that
    goes on: they would add the value of a state that they never learn.
    """

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """See `gymnasium.Env.step`; a limit of the caller's still truncates."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        finished = info["finished"]
        return observation, reward, terminated or finished, truncated and not finished, info


class SlipVecEnv(VecEnv):
    """A `SlipVectorEnv` as Stable-Baselines3 wants it.

    What it returns equals, bit for bit, what a `DummyVecEnv` of scalar environments with `engine="planar"`
    in `TaskEnd` returns, but that infos are empty where no episode ended.

    Args:
        env: The batch, with autoreset mode "SameStep".
        scenarios: Options of reset of each environment, for all its episodes; then the autoreset mode must be
            "Disabled". Options that are set for the next reset come on top.
        spread: Whether `reset` plays with actions of zero until the environments are at times spread evenly
            over their episodes. Otherwise a short rollout of equally long episodes has only one part of them.

    Attributes:
        env: The batch.
        reset_infos: Infos of the episodes' starts, for each environment.

    Raises:
        ValueError: The autoreset mode is another one, or there is not a scenario for each environment.
    """

    def __init__(
        self, env: SlipVectorEnv, scenarios: Sequence[Mapping[str, Any]] | None = None, spread: bool = False
    ) -> None:
        mode, needed = env.metadata["autoreset_mode"], _AUTORESET[scenarios is not None]
        if mode is not needed:
            raise ValueError(f"autoreset_mode = {mode.value!r} must be {needed.value!r}")
        if scenarios is not None and len(scenarios) != env.num_envs:
            raise ValueError(f"{env.num_envs} environments need as many scenarios, got {len(scenarios)}")
        self.env, self._scenarios, self._spread = env, scenarios, spread
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)
        self._actions = np.zeros(env.action_space.shape or (), dtype=np.float32)

    def reset(self) -> VecEnvObs:
        """Start episodes with the seeds and options set before; observations (n, k), or one per group."""
        fixed = self._scenarios or [{}] * self.num_envs
        rows = [{**always, **asked} for always, asked in zip(fixed, self._options, strict=True)]
        options = {"rows": rows} if any(rows) else None
        observations, infos = self.env.reset(seed=self._seeds, options=options)
        self._reset_seeds()
        self._reset_options()
        self.reset_infos = _split(infos, np.arange(self.num_envs))
        return self._spread_out() if self._spread else observations

    def step_async(self, actions: np.ndarray) -> None:
        """Take the actions (n, m) of the next `step_wait`, which does the work."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Step all environments; those whose episode ends begin another one.

        Returns:
            Observations (n, k), or such an array per group; rewards (n,) float32; whether an episode ended,
            (n,) bool; n infos. Where one ended, its info is the scalar environment's, with
            "terminal_observation" and "TimeLimit.truncated": learners add the value of the last state where
            it is true, after a limit of the caller's, not at the task's own end.

        Raises:
            ValueError: The actions have the wrong shape or are not finite.
            RuntimeError: There was no reset yet, or it is closed.
        """
        observations, rewards, terminated, truncated, infos = self.env.step(self._actions)
        dones, cut = terminated | truncated, truncated & ~terminated
        returned: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        ended = np.flatnonzero(dones)
        if len(ended):
            if self._scenarios is None:
                last, final = infos.pop("final_obs"), infos.pop("final_info")
            else:
                last, final = observations, infos
                observations, infos = self._begin(dones)
            splits = _split(final, ended), _split(infos, ended)
            grouped = isinstance(last, dict)
            for i, info, start in zip(ended.tolist(), *splits, strict=True):
                shown = {name: group[i] for name, group in last.items()} if grouped else last[i]
                info["terminal_observation"] = shown
                info["TimeLimit.truncated"] = cut.item(i) and not info["finished"]
                returned[i], self.reset_infos[i] = info, start
        return observations, rewards.astype(np.float32), dones, returned

    def close(self) -> None:
        """End the batch's threads; closing twice is harmless."""
        self.env.close()

    def get_images(self) -> Sequence[np.ndarray | None]:
        """Pictures of the batch's `render_rows`, (480, 720, 3) uint8 each."""
        return self.env.render() or ()

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """An attribute for each of some environments: they share those of the batch, but for the spaces."""
        return [getattr(self.env, _OF_ONE.get(attr_name, attr_name))] * len(self._rows(indices))

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute of the batch, which all environments share."""
        self._everyone(f"attribute {attr_name!r}", indices)
        setattr(self.env, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the batch once, for all environments; its result stands for each of them."""
        count = self._everyone(f"method {method_name!r}", indices)
        return [getattr(self.env, method_name)(*method_args, **method_kwargs)] * count

    def env_is_wrapped(
        self, wrapper_class: type[gym.Wrapper[Any, Any, Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        """False for each of some environments: those of a batch have no wrappers."""
        return [False] * len(self._rows(indices))

    def _begin(self, mask: np.ndarray) -> tuple[VecEnvObs, dict[str, Any]]:
        """Start episodes of the environments of a mask (n,), with their scenarios."""
        options: dict[str, Any] = {"reset_mask": mask}
        if self._scenarios is not None:
            pairs = zip(self._scenarios, mask, strict=True)
            options["rows"] = [scenario if begins else None for scenario, begins in pairs]
        return self.env.reset(options=options)

    def _spread_out(self) -> VecEnvObs:
        """Play until environment i is at the share i * _GOLDEN mod 1 of its episode."""
        skip = round(self.env.config.physics.control_rate / self.env.metadata["render_fps"])
        lengths = -(-self.env.simulation.episode["steps"] // skip)
        played = 1 + (np.arange(self.num_envs) * _GOLDEN % 1.0 * lengths).astype(int)
        left, idle = lengths.max(), np.zeros(self.env.action_space.shape or (), dtype=np.float32)
        observations: VecEnvObs = ()
        for steps in range(left, 0, -1):
            begins = played == steps
            if begins.any():
                _, infos = self._begin(begins)
                rows = np.flatnonzero(begins)
                for i, start in zip(rows.tolist(), _split(infos, rows), strict=True):
                    self.reset_infos[i] = start
            self.step_async(idle)
            observations = self.step_wait()[0]
        return observations

    def _rows(self, indices: VecEnvIndices) -> list[int]:
        rows = list(self._get_indices(indices))
        for row in rows:
            if not -self.num_envs <= row < self.num_envs:
                raise ValueError(f"indices: {row!r} must be a whole number from 0 to {self.num_envs - 1}")
        return rows

    def _everyone(self, shared: str, indices: VecEnvIndices) -> int:
        """How many indices there are; ValueError unless they name every environment."""
        rows = self._rows(indices)
        if len({row % self.num_envs for row in rows}) < self.num_envs:
            n = self.num_envs
            raise ValueError(f"indices = {indices!r}: all {n} environments share the {shared}; give None")
        return len(rows)


def make_vec_env(
    env_id: str,
    num_envs: int = 1,
    seed: int | None = None,
    threads: int | None = None,
    normalise: Mapping[str, Any] | None = None,
    scenarios: Sequence[Mapping[str, Any]] | None = None,
    spread: bool = False,
    privileged: bool = False,
    **keywords: Any,
) -> VecMonitor | VecNormalize:
    """Environments for Stable-Baselines3, stepped by one compiled call, with statistics of their episodes.

    Args:
        env_id: The task, "Carry" or "carry", or the id of an environment, "slipgym/Carry-v0".
        num_envs: Environments.
        seed: Of the first environment, the others count up from it, as of the first reset; None: drawn by the
            operating system. A learner that is given a seed sets its own.
        threads: Threads that share the environments; None: as many as processors, if there is work for them.
        normalise: Keyword arguments of a `VecNormalize` around them, {} for its own; None: there is none.
        scenarios: See `SlipVecEnv`.
        spread: See there.
        privileged: Whether the learner keeps the group "privileged" from its actor: without, observations may
            not be a dict, which Stable-Baselines3 shows the actor whole.
        **keywords: Of the environment.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
        TypeError: An argument is unknown.
    """
    mode = str(keywords.get("observation_mode"))
    if mode.endswith("dict") and not privileged:
        raise ValueError(
            f"observation_mode = {mode!r} would show the true friction to the actor: Stable-Baselines3 joins "
            "all groups. Use 'flat', or algorithm privileged_ppo of `slipgym train`: only its critic reads it"
        )
    batch = gym.make_vec(
        env_id if "/" in env_id else f"slipgym:{find(env_id).id}",
        num_envs,
        "vector_entry_point",
        autoreset_mode=_AUTORESET[scenarios is not None],
        threads=threads,
        **keywords,
    )
    assert isinstance(batch, SlipVectorEnv)
    envs = VecMonitor(SlipVecEnv(batch, scenarios, spread))
    if seed is not None:
        envs.seed(seed)
    return envs if normalise is None else VecNormalize(envs, **normalise)


def _split(infos: Mapping[str, Any], rows: np.ndarray) -> list[dict[str, Any]]:
    """What infos of a batch say about each of some environments: its own arrays, plain numbers."""
    columns: dict[str, list[Any]] = {}
    for name, values in infos.items():
        if isinstance(values, dict):
            columns[name] = _split(values, rows)
        elif not name.startswith("_"):
            taken = values[rows]
            columns[name] = taken.tolist() if taken.ndim == 1 else list(taken)
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
