"""Builds the parts that scalar and vector environments have in common, from keyword arguments."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from slipgym.config import Config, Randomization, TaskConfig, load, load_randomization
from slipgym.config.level import load_level
from slipgym.envs.actions import ACTION_MODES, GUESS, Actions
from slipgym.envs.arguments import CommonArguments, fields, friction_part, one_of
from slipgym.envs.drawn_over import warn_of_drawn
from slipgym.envs.observer import Observer
from slipgym.envs.sensor_part import LOADED, layout_of
from slipgym.envs.simulation import Simulation
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
        if values["load_columns"] and layout_of(self.config) not in LOADED:
            raise ValueError(
                f"load_columns = True: sensors = {values['sensors']!r} has no force sensor in each finger"
            )
        warn_if_slow(self.config, values["frame_skip"])
        keys = [each.key for each in TASKS.values()]
        randomization = load_randomization(values["randomization"], keys)
        self.randomization = level.level.applied_to(randomization, task.key)
        self.material = one_of("material", values["material"], ("random", *self.config.materials))
        ranges = self.randomization.of(task.key)
        warn_of_drawn(values["config"], ranges, self.settings, task.key, self.material)
        values["action_mode"] = values["action_mode"] or task.action_mode
        if values["estimator"] is None:
            _check_guess(task, values["action_mode"])
        self.actions = Actions(values["action_mode"], self.config, self.settings.wrist_speed)
        self.simulation = make_simulation(
            self.config, self.settings, task, values["estimator"], self.randomization
        )
        self.simulation.blank["end_at_violation"] = values["end_at_violation"]
        names = "action_mode", "observation_mode", "history", "load_columns"
        layout = [values[name] for name in names]
        source = friction_part(values["friction_source"], values["estimator"])
        self.observer = Observer(self.simulation, source, *layout)
        self.arguments: dict[str, Any] = {
            **values,
            "estimator": self.simulation.estimator_choice,
            "level": level.argument,
            "randomization": randomization.model_dump(mode="json", exclude_unset=True),
            "config": recorded(self.config, self.settings, task.key),
        }


def _check_guess(task: Task, action_mode: str) -> None:
    """Refuse an action mode in which the estimate would have to take the place of the agent's guess.

    Raises:
        ValueError: The task scores a guess of friction that no action states.
    """
    guessed = ACTION_MODES[task.action_mode][-1]
    if guessed in GUESS and guessed not in ACTION_MODES[action_mode]:
        raise ValueError(
            f"action_mode = {action_mode!r}: {task.name} then scores the estimate, and this environment has "
            f"estimator=None; valid: {task.action_mode}"
        )


SLOW = 100.0
"""Work of a step over that of the defaults from which there is a warning."""


def work(config: Config, frame_skip: int = 1) -> float:
    """Upper bound of the work of a step, in arbitrary units: sub-steps, sensor samples, engine iterations.

    Args:
        config: Configuration.
        frame_skip: Control steps per step.
    """
    physics, contact = config.physics, config.contact
    patches = contact.model == "distributed"
    longest = min(physics.substep_max, physics.patch_substep_max) if patches else physics.substep_max
    per_substep = 1.0 + contact.cells**2 / 40.0 if patches else 1.0  # a patch of 21 cells: 12 ellipsoids
    substeps = 1.0 / (physics.control_rate * longest) * per_substep
    samples = config.sensors.force_torque.rate / physics.control_rate
    return frame_skip * (substeps + samples + physics.engine_steps * physics.solver_iterations)


def warn_if_slow(config: Config, frame_skip: int) -> None:
    """Warn if a step may take `SLOW` times as long as one of the defaults with the same friction model."""
    ratio = work(config, frame_skip) / _default_work(config.contact.model)
    if ratio > SLOW:
        message = (
            f"a step may take {ratio:.0f} times as long as with the defaults: see physics.control_rate, "
            "substep_max, engine_steps and solver_iterations, sensors.force_torque.rate, contact.cells and "
            "frame_skip"
        )
        warnings.warn(message, stacklevel=2)


@cache
def _default_work(model: str) -> float:
    return work(load(contact=model))
