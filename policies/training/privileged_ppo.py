"""PPO of rsl-rl whose critic reads what the actor does not: memory, a start from a policy, stages.

A learner here has the methods of one of Stable-Baselines3 that a run calls.
"""

from __future__ import annotations

import contextlib
import io
from collections import deque
from types import SimpleNamespace
from typing import Any

import numpy as np
import torch
from rsl_rl.algorithms import PPO
from stable_baselines3.common.running_mean_std import RunningMeanStd
from tensordict import TensorDict

from policies.training import policy_tensors, vector
from policies.training.config import Training
from policies.training.derived import coefficients
from policies.training.memory import remembering
from policies.training.mirror import Mirror
from policies.training.state_checks import arrays, check_like, moments, set_moments, tensors

_FIRST_OUTPUT = 0.01
"""What the last layer of a new actor is multiplied with: its first actions are about the middle."""
_CHECKED = "counters", "normalisation", "running"
"""Parts of a state that are compared with the learner's own; torch and the environments check the others."""


class PrivilegedPPO:
    """Learns in the environments of a run; the seed is that of the first one, and of the networks.

    Attributes:
        num_timesteps: Steps of all environments so far.
        matrix: What turns an observation into its derived columns, (d, k).
        mirror: What mirrors its samples, if anything does.
        stage: Number of the curriculum's present stage; as many as there are: the task itself.
        envs: The environments of that stage.
    """

    def __init__(self, config: Training, seed: int) -> None:
        torch.set_num_threads(config.threads)
        torch.manual_seed(seed)
        self._config, self._seed, self._chosen = config, seed, config.privileged_ppo
        self.num_timesteps, self.stage, self._updates = 0, 0, 0
        self.envs = self._make()
        self._returns, self._running = RunningMeanStd(shape=()), np.zeros(config.num_envs)
        spaces = self.envs.observation_space.spaces
        self.moments = {name: RunningMeanStd(shape=space.shape) for name, space in spaces.items()}
        self._solved: deque[bool] = deque(maxlen=self._chosen.curriculum.episodes)
        self._last: TensorDict | None = None
        columns, width = self.envs.get_attr("columns")[0], spaces["policy"].shape[0]
        history = config.environment.history
        self.matrix = coefficients(config.derived, columns, history, width)
        mirrored = self._chosen.mirrored
        self.mirror = Mirror(mirrored, self.envs, config.derived, history) if mirrored else None
        self.ppo = self._ppo()
        self.logger: Any = None
        if (start := self._chosen.start) is not None:
            policy_tensors.load(self.ppo.actor, self.moments["policy"], self.matrix, start, config)

    def _make(self) -> Any:
        return vector.make(self._config.at_stage(self.stage), self._seed, shaped=True)

    def _ppo(self) -> PPO:
        chosen, spaces = self._chosen, self.envs.observation_space.spaces
        shapes = {name: (self.envs.num_envs, *space.shape) for name, space in spaces.items()}
        like = self._observed(
            {name: np.zeros(shape, np.float32) for name, shape in shapes.items()}, learn=False
        )
        common = {"hidden_dims": list(chosen.net_arch), "activation": chosen.activation}
        noise = {"class_name": "rsl_rl.modules.distribution:GaussianDistribution", "std_type": "log"}
        noise |= {"init_std": float(np.exp(chosen.log_std_init))}
        dense = {"class_name": "rsl_rl.models.mlp_model:MLPModel"}
        memory = {"class_name": "rsl_rl.models.rnn_model:RNNModel", "rnn_type": "lstm"}
        memory |= {"rnn_hidden_dim": chosen.memory, "rnn_num_layers": 1}
        read = ["policy", "privileged"] if chosen.privileged else ["policy"]
        settings = {
            "num_steps_per_env": chosen.n_steps,
            "obs_groups": {"actor": ["policy"], "critic": read},
            "multi_gpu": None,
            "actor": {**common, "distribution_cfg": noise, **(memory if chosen.memory else dense)},
            "critic": {**common, **dense},
            "algorithm": {
                "class_name": "rsl_rl.algorithms.ppo:PPO",
                "num_learning_epochs": chosen.n_epochs,
                "num_mini_batches": chosen.n_minibatches,
                "gamma": chosen.gamma,
                "lam": chosen.gae_lambda,
                "clip_param": chosen.clip_range,
                "entropy_coef": chosen.ent_coef,
                "value_loss_coef": chosen.vf_coef,
                "max_grad_norm": chosen.max_grad_norm,
                "learning_rate": chosen.learning_rate,
                "schedule": "fixed",
                "use_clipped_value_loss": False,
                "symmetry_cfg": self.mirror
                and {"data_augmentation_func": self.mirror, "use_data_augmentation": True},
            },
        }
        where: Any = SimpleNamespace(num_envs=self.envs.num_envs, num_actions=self.envs.action_space.shape[0])
        with contextlib.redirect_stdout(io.StringIO()):  # rsl-rl prints the networks
            made = PPO.construct_algorithm(like, where, settings, "cpu")
        made.train_mode()
        with torch.no_grad():
            layers = [layer for layer in made.actor.mlp if isinstance(layer, torch.nn.Linear)]
            layers[-1].weight.mul_(_FIRST_OUTPUT)
        if chosen.memory:
            actor: Any = made.actor
            remembering(actor.rnn.rnn, chosen.memory_horizon)
        return made

    def get_env(self) -> Any:
        """The environments in which it learns now."""
        return self.envs

    def set_logger(self, logger: Any) -> None:
        """Take the logger of the run."""
        self.logger = logger

    def learn(self, total: int, callback: Any, reset_num_timesteps: bool = True) -> None:
        """Collects and updates for a number of steps, or until the callback says that it is over."""
        end = self.num_timesteps + total
        callback.init_callback(self)
        if self._last is None:
            self._last = self._observed(self.envs.reset())
        while self.num_timesteps < end:
            callback.on_rollout_start()
            if not self._collect(callback):
                break
            self._update(min(self.num_timesteps / self._config.budget, 1.0))
            self._go_on()
        callback.on_training_end()

    def _observed(self, observations: Any, learn: bool = True) -> TensorDict:
        """Normalised observations by group, from which their moments are learned."""
        chosen, found = self._config.normalisation, {}
        for name, values in observations.items():
            rms, scaled = self.moments[name], values
            if chosen.observation:
                if learn:
                    rms.update(values)
                    if self.mirror is not None:  # the mean of a mirrored column is 0
                        rms.update(values * self.mirror.groups[name].numpy()[: values.shape[1]])
                scaled = (values - rms.mean) / np.sqrt(rms.var + policy_tensors.EPSILON)
                scaled = np.clip(scaled, -chosen.clip, chosen.clip).astype(np.float32)
            if name == "policy" and len(self.matrix):
                scaled = np.concatenate((scaled, values @ self.matrix.T), axis=1, dtype=np.float32)
            found[name] = torch.from_numpy(scaled)
        return TensorDict(found, batch_size=[len(observations["policy"])])

    def _collect(self, callback: Any) -> bool:
        """Plays the steps of one update; False if the callback ends the run."""
        gamma = self._chosen.gamma
        with torch.inference_mode():
            for _ in range(self._chosen.n_steps):
                actions = np.clip(self.ppo.act(self._last).numpy(), -1.0, 1.0)
                observations, rewards, dones, infos = self.envs.step(actions)
                self.num_timesteps += len(dones)
                if not callback.on_step():
                    return False
                self._running = self._running * gamma + rewards
                self._returns.update(self._running)
                self._running[dones] = 0.0
                self._solved.extend(bool(infos[i]["is_success"]) for i in np.flatnonzero(dones).tolist())
                chosen = self._config.normalisation
                scale = np.sqrt(self._returns.var + 1e-8) if chosen.reward else 1.0
                scaled = np.clip(rewards / scale, -chosen.clip, chosen.clip)
                self._last = self._observed(observations)
                self.ppo.process_env_step(
                    self._last, torch.from_numpy(scaled.astype(np.float32)), torch.from_numpy(dones), {}
                )
            self.ppo.compute_returns(self._last)
        return True

    def _update(self, done: float) -> None:
        chosen = self._chosen
        rate = chosen.learning_rate * (1.0 + (chosen.learning_rate_end - 1.0) * done)
        for group in self.ppo.optimizer.param_groups:
            group["lr"] = rate
        self.ppo.actor.requires_grad_(self._updates >= chosen.critic_first)
        losses = self.ppo.update()
        self._updates += 1
        if self.logger is not None:
            solved = float(np.mean(self._solved)) if self._solved else 0.0
            losses |= {"solved": solved, "stage": self.stage, "learning_rate": rate}
            for name, value in losses.items():
                self.logger.record_mean(f"train/{name}", value)

    def _go_on(self) -> None:
        """Begins the next stage of the curriculum if enough of the last episodes were solved."""
        course = self._chosen.curriculum
        full = len(self._solved) == course.episodes
        if self.stage < len(course.stages) and full and np.mean(self._solved) >= course.success:
            self.stage += 1
            self.envs.close()
            self.envs = self._make()
            self._last = self._observed(self.envs.reset())
            with torch.inference_mode():
                self.ppo.actor.reset(torch.ones(self.envs.num_envs, dtype=torch.bool))
            self._running[:] = 0.0
            self._solved.clear()

    def predict(
        self, observations: Any, state: Any, starts: np.ndarray, deterministic: bool = True
    ) -> tuple[np.ndarray, Any]:
        """Actions (n, k) without exploration, and the memory after them; see Stable-Baselines3.

        Observations are given by group, (n, m) each; the state from the call before, None at first; and which
        episodes begin, (n,).
        """
        actor, own = self.ppo.actor, self.ppo.actor.get_hidden_state()
        with torch.inference_mode():
            actor.reset(hidden_state=state)
            actor.reset(torch.from_numpy(starts)) if state is not None else None
            actions = np.clip(actor(self._observed(observations, learn=False)).numpy(), -1.0, 1.0)
            after = actor.get_hidden_state()
            actor.reset(hidden_state=own)
        return actions, after

    def get_state(self, environments: bool = True) -> dict[str, Any]:
        """Everything that decides how training goes on, maybe without environments and random numbers."""
        state: dict[str, Any] = {
            "parameters": arrays(self.ppo.save()),
            "counters": {"steps": self.num_timesteps, "updates": self._updates, "stage": self.stage},
            "normalisation": {name: moments(rms) for name, rms in self._all_moments().items()},
        }
        if environments:
            state |= {
                "running": self._running.copy(),
                "solved": list(self._solved),
                "last": None if self._last is None else arrays(dict(self._last.items())),
                "memory": arrays(self.ppo.actor.get_hidden_state()),
                "environments": vector.get_state(self.envs),
                "torch": torch.get_rng_state().numpy().copy(),
            }
        return state

    def set_state(self, state: dict[str, Any]) -> None:
        """Go on from a state.

        Raises:
            ValueError: It is of a learner with another configuration.
        """
        given, own = ({k: one[k] for k in _CHECKED} for one in (state, self.get_state()))
        check_like("learner", given, own)
        self.set_parameters(state)
        counters = state["counters"]
        self.num_timesteps, self._updates = counters["steps"], counters["updates"]
        if counters["stage"] != self.stage:
            self.stage = counters["stage"]
            self.envs.close()
            self.envs = self._make()
        self.envs.reset()
        self._running = state["running"].copy()
        self._solved.extend(state["solved"])
        last = tensors(state["last"])
        self._last = None if last is None else TensorDict(last, batch_size=[self.envs.num_envs])
        self.ppo.actor.reset(hidden_state=tensors(state["memory"]))
        vector.set_state(self.envs, state["environments"])
        torch.set_rng_state(torch.from_numpy(state["torch"].copy()))

    def set_parameters(self, state: dict[str, Any]) -> None:
        """Give it the parameters of a state, that of the optimiser included."""
        self.ppo.load(tensors(state["parameters"]), None, strict=True)
        for name, rms in self._all_moments().items():
            set_moments(rms, state["normalisation"][name])

    def _all_moments(self) -> dict[str, RunningMeanStd]:
        return {**self.moments, "returns": self._returns}
