"""Stable-Baselines3's PPO with less computing time per sample: the same losses, gradients and minibatches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.utils import explained_variance
from stable_baselines3.common.vec_env import VecEnv
from torch import nn
from torch.nn.functional import mse_loss

_NORMALISER = 0.5 * math.log(2.0 * math.pi)
"""-ln of a standard normal density at 0."""


class GaussianPolicy(ActorCriticPolicy):
    """A policy of multilayer perceptrons with Gaussian noise of the same deviation in all states.

    It computes what Stable-Baselines3's "MlpPolicy" does, without objects of distributions.
    """

    def forward(
        self, obs: torch.Tensor, deterministic: bool = False
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Actions (n, m), values (n, 1) and log probabilities (n,) of observations (n, k)."""
        mean, values = self._outputs(obs)
        noise = torch.zeros_like(mean) if deterministic else torch.randn_like(mean)
        actions = torch.addcmul(mean, noise, self.log_std.exp())
        return actions, values, self._log_density(noise)

    def evaluate_actions(
        self, obs: torch.Tensor, actions: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Values (n, 1) of observations (n, k), log probabilities (n,) of actions (n, m), entropy ()."""
        mean, values = self._outputs(obs)
        entropy = (self.log_std + (0.5 + _NORMALISER)).sum()
        return values, self._log_density((actions - mean) * (-self.log_std).exp()), entropy

    def _outputs(self, obs: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Means of actions (n, m) and values (n, 1)."""
        latent, latent_value = self.mlp_extractor(obs)
        return self.action_net(latent), self.value_net(latent_value)

    def _log_density(self, noise: torch.Tensor) -> torch.Tensor:
        """Log probability (n,) of actions that differ from their mean by noise (n, m) deviations."""
        return -0.5 * noise.square().sum(1) - (self.log_std + _NORMALISER).sum()


class VectorPPO(PPO):
    """PPO on observations that are vectors, actions in a box, "MlpPolicy", on the CPU.

    An update takes each pass over a rollout as tensors that are permuted once, computes what is only logged
    in the last pass, and clips gradients in one call. A rollout evaluates the last observations of truncated
    episodes together. Random numbers come from the same generators, in the same order, as in
    Stable-Baselines3. Exploration that depends on the state, `target_kl` and `clip_range_vf` are left to it.
    """

    policy_aliases: ClassVar = {**PPO.policy_aliases, "MlpPolicy": GaussianPolicy}
    policy: GaussianPolicy

    def collect_rollouts(
        self, env: VecEnv, callback: BaseCallback, rollout_buffer: RolloutBuffer, n_rollout_steps: int
    ) -> bool:
        """Fill the buffer; False if the callback ended learning before.

        Args:
            env: The environments.
            callback: Called at each step and at both ends.
            rollout_buffer: To be filled.
            n_rollout_steps: Steps of each environment.
        """
        self.policy.set_training_mode(False)
        rollout_buffer.reset()
        callback.on_rollout_start()
        space: Any = self.action_space
        for _ in range(n_rollout_steps):
            observations: Any = self._last_obs
            with torch.no_grad():
                actions, values, log_probs = self.policy(torch.from_numpy(observations))
            actions = actions.numpy()
            step: Any = env.step(np.clip(actions, space.low, space.high))
            self._last_obs, rewards, dones, infos = step
            self.num_timesteps += env.num_envs
            callback.update_locals(locals())
            if not callback.on_step():
                return False
            ended = np.flatnonzero(dones).tolist()
            self._update_info_buffer([infos[i] for i in ended], dones[ended])
            truncated = [i for i in ended if infos[i].get("TimeLimit.truncated", False)]
            if truncated:
                last = np.stack([infos[i]["terminal_observation"] for i in truncated])
                rewards[truncated] += self.gamma * self._values(last).numpy()[:, 0]
            starts: Any = self._last_episode_starts
            rollout_buffer.add(observations, actions, rewards, starts, values, log_probs)
            self._last_episode_starts = dones
        rollout_buffer.compute_returns_and_advantage(self._values(self._last_obs), dones)
        callback.update_locals(locals())
        callback.on_rollout_end()
        return True

    def train(self) -> None:
        """Update the policy with the samples of the buffer."""
        policy, buffer = self.policy, self.rollout_buffer
        policy.set_training_mode(True)
        self._update_learning_rate(policy.optimizer)
        schedule: Any = self.clip_range
        clip = schedule(self._current_progress_remaining)
        parameters = list(policy.parameters())
        names = ("observations", "actions", "log_probs", "advantages", "returns")
        arrays = [torch.from_numpy(buffer.swap_and_flatten(getattr(buffer, name))) for name in names]
        figures: dict[str, list[float]] = {}
        for epoch in range(self.n_epochs):
            for minibatch in self.minibatches(arrays):
                loss, logged = self.loss(*minibatch, clip=clip, log=epoch == self.n_epochs - 1)
                policy.optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(parameters, self.max_grad_norm, foreach=True)
                policy.optimizer.step()
                for name, value in logged.items():
                    figures.setdefault(name, []).append(value)
            self._n_updates += 1
        figures["explained_variance"] = [explained_variance(buffer.values.ravel(), buffer.returns.ravel())]
        figures["std"] = [policy.log_std.detach().exp().mean().item()]
        for name, values in figures.items():
            self.logger.record(f"train/{name}", np.mean(values))

    def minibatches(self, arrays: Sequence[torch.Tensor]) -> list[tuple[torch.Tensor, ...]]:
        """The samples of arrays (n, ...) in random order, in minibatches."""
        order = torch.from_numpy(np.random.permutation(len(arrays[0])))  # noqa: NPY002
        shuffled = (array[order].split(self.batch_size) for array in arrays)
        return list(zip(*shuffled, strict=True))

    def loss(
        self,
        observations: torch.Tensor,
        actions: torch.Tensor,
        log_probs: torch.Tensor,
        advantages: torch.Tensor,
        returns: torch.Tensor,
        clip: float,
        log: bool,
    ) -> tuple[torch.Tensor, dict[str, float]]:
        """The clipped loss of a minibatch (Schulman et al., arXiv 1707.06347, equation 9), and its figures.

        Args:
            observations: (n, k).
            actions: (n, m).
            log_probs: Of the actions, when they were chosen, (n, 1).
            advantages: (n, 1).
            returns: (n, 1).
            clip: Largest change of the ratio of probabilities.
            log: Whether to compute figures for the logger.
        """
        values, log_prob, entropy = self.policy.evaluate_actions(observations, actions)
        advantages = advantages.flatten()
        if self.normalize_advantage and len(advantages) > 1:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        log_ratio = log_prob - log_probs.flatten()
        ratio = log_ratio.exp()
        clipped = ratio.clamp(1.0 - clip, 1.0 + clip)
        policy_loss = -torch.min(advantages * ratio, advantages * clipped).mean()
        value_loss = mse_loss(returns, values)
        loss = policy_loss + self.vf_coef * value_loss
        if self.ent_coef:
            loss = loss - self.ent_coef * entropy
        if not log:
            return loss, {}
        with torch.no_grad():
            return loss, {
                "policy_gradient_loss": policy_loss.item(),
                "value_loss": value_loss.item(),
                "entropy_loss": -entropy.item(),
                "approx_kl": (ratio - 1.0 - log_ratio).mean().item(),
                "clip_fraction": ((ratio - 1.0).abs() > clip).float().mean().item(),
            }

    def _values(self, observations: Any) -> torch.Tensor:
        """Values (n, 1) of observations (n, k)."""
        with torch.no_grad():
            return self.policy.predict_values(torch.from_numpy(observations))
