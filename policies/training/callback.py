"""Evaluates a run between updates, writes its checkpoints, and decides when it ends."""

from __future__ import annotations

import time
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecEnv
from tqdm import tqdm

from policies.training import checkpoints, folder, seeds
from policies.training import model as learners
from policies.training.config import Training
from policies.training.curve import Row, best

STOPS_UNTRAINED = (
    "before any learning the policy solves {:.0%} of the evaluation episodes, and stop.success is {}: the "
    "run may end without having learned anything. Raise stop.success, or leave it out"
)
"""Warning for a stopping rule that is met at step 0."""


class TrainingCallback(BaseCallback):
    """Writes the curve and the checkpoints of a run.

    It acts where a collection of samples begins, when the update before it is complete: there the state of
    the run is its learner, its environments, and the record. It evaluates in `envs`.

    Attributes:
        curve: The evaluations so far.
        ended: Why the run is over, "success" or "budget"; empty while it is not.
        seconds: Time spent so far [s].
        cpu_seconds: Time of the processor spent so far by this process [s].
    """

    def __init__(self, config: Training, path: Path, envs: VecEnv, bar: tqdm) -> None:
        super().__init__()
        self._config, self._path, self._envs, self._bar = config, path, envs, bar
        self.curve: list[Row] = []
        self.ended, self.seconds, self.cpu_seconds = "", 0.0, 0.0
        self._next_evaluation, self._next_checkpoint = 0, config.checkpoints.every
        self._since = time.perf_counter(), time.process_time()

    def get_state(self) -> dict[str, Any]:
        """The record as plain data."""
        now = time.perf_counter(), time.process_time()
        self.seconds += now[0] - self._since[0]
        self.cpu_seconds += now[1] - self._since[1]
        self._since = now
        return {
            "curve": [asdict(row) for row in self.curve],
            **{name: getattr(self, name) for name in ("ended", "seconds", "cpu_seconds")},
            "next": [self._next_evaluation, self._next_checkpoint],
        }

    def set_state(self, state: dict[str, Any]) -> None:
        """Go on from a record."""
        self.curve = [Row(**values) for values in state["curve"]]
        self.ended, self.seconds = state["ended"], state["seconds"]
        self.cpu_seconds = state.get("cpu_seconds", 0.0)  # checkpoints of 0.1.0 have none
        self._next_evaluation, self._next_checkpoint = state["next"]
        folder.write_curve(self._path, self.curve)

    def _on_step(self) -> bool:
        self._bar.update(self.num_timesteps - self._bar.n)
        return not self.ended

    def _on_training_end(self) -> None:
        if not self.ended:
            self._on_rollout_start()

    def _on_rollout_start(self) -> None:
        steps = self.model.num_timesteps
        learners.check_finite(self.model)
        if steps >= self._config.budget:
            self.ended = "budget"
        if self.ended or steps >= self._next_evaluation:
            self._evaluate()
            self._next_evaluation = (steps // (every := self._config.evaluation.every) + 1) * every
        if self.ended or steps >= self._next_checkpoint:
            self._next_checkpoint = (steps // (every := self._config.checkpoints.every) + 1) * every
            state = {"record": self.get_state(), "learner": learners.get_state(self.model)}
            checkpoints.save(self._path, steps, state, self._config.checkpoints.keep)
        if getattr(self.model, "use_sde", False):
            learners.renew_noise(self.model)

    def _evaluate(self) -> None:
        config, row = self._config, evaluate(self._config, self.model, self._envs)
        self.curve.append(row)
        if best(self.curve, config.evaluation.episodes) is row:
            state = {"row": asdict(row), "learner": learners.get_state(self.model, replay=False)}
            checkpoints.write(checkpoints.best(self._path), state)
        folder.write_curve(self._path, self.curve)
        for name, value in asdict(row).items():
            self.logger.record(f"evaluation/{name}", value)
        self.logger.dump(row.steps)
        shown = {"success": f"{row.success:.0%}", "drops": f"{row.drops:.0%}"}
        stages = len(config.privileged_ppo.curriculum.stages)
        if config.algorithm == "privileged_ppo" and stages:
            shown["stage"] = f"{self.model.stage + 1} of {stages + 1}"  # type: ignore[attr-defined]
        self._bar.set_postfix(shown)
        stop, last = config.stop, self.curve[-config.stop.evaluations :]
        reached = [stop.success is not None and one.success >= stop.success for one in last]
        if len(self.curve) == 1 and all(reached):
            warnings.warn(STOPS_UNTRAINED.format(row.success, stop.success), stacklevel=2)
        if len(last) == stop.evaluations and all(reached):
            self.ended = "success"


def evaluate(config: Training, model: Any, envs: VecEnv) -> Row:
    """Runs episodes without exploration, always the same ones, with the learner's statistics as they are."""
    frozen: Any = envs
    if config.algorithm != "privileged_ppo":
        frozen = learners.normalised(config, envs, training=False)
        if frozen.norm_obs:
            frozen.obs_rms = model.get_vec_normalize_env().obs_rms
    wanted, found = config.evaluation.episodes, []
    for begun in range(0, wanted, envs.num_envs):
        count = min(envs.num_envs, wanted - begun)
        found += _episodes(model, frozen, seeds.held_out(config.evaluation.first_seed + begun))[:count]
    success, drops, reward, length = np.mean(found, axis=0).tolist()
    return Row(model.num_timesteps, success, drops, reward, length)


def _episodes(model: Any, envs: Any, seed: int) -> list[tuple[float, ...]]:
    """One episode of each environment: success, drop, sum of rewards, length."""
    envs.seed(seed)
    observations: Any = envs.reset()
    outcomes: dict[int, tuple[float, ...]] = {}
    state, starts = None, np.ones(envs.num_envs, dtype=bool)
    while len(outcomes) < envs.num_envs:
        actions, state = model.predict(observations, state, starts, deterministic=True)
        observations, _, starts, infos = envs.step(actions)
        for i in np.flatnonzero(starts).tolist():
            info = infos[i]
            outcome = info["is_success"], info["dropped"], info["episode"]["r"], info["episode"]["l"]
            outcomes.setdefault(i, outcome)
    return [outcomes[i] for i in range(envs.num_envs)]
