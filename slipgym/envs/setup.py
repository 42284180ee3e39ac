"""Builds the parts that scalar and vector environments have in common."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from slipgym.config import Config, Randomization, TaskConfig, load_randomization
from slipgym.config.level import load_level
from slipgym.envs.actions import Actions
from slipgym.envs.arguments import CommonArguments, fields, one_of
from slipgym.envs.observer import Observer
from slipgym.envs.simulation import Simulation
from slipgym.envs.workload import warn_if_slow
from slipgym.tasks import TASKS, Task, configure
from slipgym.tasks.configure import recorded

MakeSimulation = Callable[[Config, TaskConfig, Task, Any, Randomization], Simulation]


class Setup:
    """Builds configuration, actions, simulation and observer from keyword arguments.

    Args:
        task: The task.
        arguments: `CommonArguments`, all of them.
        make_simulation: Makes the simulation from configuration, settings, task, estimator and randomization.

    Attributes:
        config: The configuration.
        settings: The task's settings.
        randomization: Distributions that an episode is sampled from, those of the level in place.
        material: Name of the material, or "random".
        actions: Action space and the meaning of actions.
        simulation: The simulation.
        observer: Assembles its observations.
        arguments: JSON-able arguments that make the same environment.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
    """

    def __init__(self, task: Task, arguments: Mapping[str, Any], make_simulation: MakeSimulation) -> None:
        values = {name: arguments[name] for name in fields(CommonArguments)}
        level = load_level(values["level"], task.key)
        given = values["config"], values["sensors"], values["contact"]
        self.config, self.settings = configure(task, *given, level)
        warn_if_slow(self.config, values["frame_skip"])
        keys = [each.key for each in TASKS.values()]
        randomization = load_randomization(values["randomization"], keys)
        self.randomization = level.level.applied_to(randomization, task.key)
        self.material = one_of("material", values["material"], ("random", *self.config.materials))
        values["action_mode"] = values["action_mode"] or task.action_mode
        self.actions = Actions(values["action_mode"], self.config, self.settings.wrist_speed)
        self.simulation = make_simulation(
            self.config, self.settings, task, values["estimator"], self.randomization
        )
        layout = values["action_mode"], values["observation_mode"], values["history"]
        self.observer = Observer(self.simulation, values["friction_source"], *layout)
        self.arguments: dict[str, Any] = {
            **values,
            "estimator": self.simulation.estimator_choice,
            "level": level.argument,
            "randomization": randomization.model_dump(mode="json", exclude_unset=True),
            "config": recorded(self.config, self.settings, task.key),
        }
