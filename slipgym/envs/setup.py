"""What the scalar and the vector environment are made of."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from slipgym.config import Config, Randomization, TaskConfig, load_randomization
from slipgym.envs.actions import ACTION_MODES, Actions
from slipgym.envs.choices import DEFAULT_ESTIMATOR, one_of, whole
from slipgym.envs.observer import Observer
from slipgym.envs.simulation import Simulation
from slipgym.tasks import TASKS, Task, configure
from slipgym.tasks.configure import recorded

MakeSimulation = Callable[[Config, TaskConfig, Task, Any, Randomization], Simulation]


class Setup:
    """Checked keyword arguments, and the parts they ask for.

    Args:
        task: The task.
        make_simulation: Makes the loop from configuration, task, estimator and randomization.
        friction_source: See `slipgym.envs.slip_env.SlipEnv`, like all that follow.
        estimator: See there.
        contact: See there.
        sensors: See there.
        material: See there.
        action_mode: See there.
        observation_mode: See there.
        history: See there.
        randomization: See there.
        frame_skip: See there.
        config: See there.

    Attributes:
        config: The configuration.
        settings: The task's settings.
        randomization: What is drawn.
        actions: What actions mean.
        simulation: The simulation.
        observer: What is observed.
        arguments: JSON-able; the same environment can be made of them.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
    """

    def __init__(
        self,
        task: Task,
        make_simulation: MakeSimulation,
        friction_source: str = "estimated",
        estimator: str | Mapping[str, Any] = DEFAULT_ESTIMATOR,
        contact: str = "ellipsoid",
        sensors: str = "realistic",
        material: str = "random",
        action_mode: str | None = None,
        observation_mode: str = "flat",
        history: int = 0,
        randomization: str | os.PathLike[str] | Mapping[str, Any] = "none",
        frame_skip: int = 1,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    ) -> None:
        one_of("contact", contact, ("ellipsoid", "distributed"))
        action_mode = one_of("action_mode", action_mode or task.action_mode, ACTION_MODES)
        self.config, self.settings = configure(task, config, sensors, contact)
        self.randomization = load_randomization(randomization, [each.key for each in TASKS.values()])
        self.material = one_of("material", material, ("random", *self.config.materials))
        self.frame_skip = whole("frame_skip", frame_skip, 1)
        self.actions = Actions(action_mode, self.config)
        self.simulation = make_simulation(self.config, self.settings, task, estimator, self.randomization)
        self.observer = Observer(self.simulation, friction_source, action_mode, observation_mode, history)
        self.arguments: dict[str, Any] = {
            "friction_source": friction_source,
            "estimator": self.simulation.estimator_choice,
            "contact": contact,
            "sensors": sensors,
            "material": material,
            "action_mode": action_mode,
            "observation_mode": observation_mode,
            "history": history,
            "randomization": self.randomization.model_dump(mode="json", exclude_unset=True),
            "frame_skip": frame_skip,
            "config": recorded(self.config, self.settings, task.key),
        }
