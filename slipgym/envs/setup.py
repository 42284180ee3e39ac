"""Builds the parts that scalar and vector environments have in common, from keyword arguments."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from slipgym.config import Config, Overrides, Randomization, Ranges, TaskConfig, load, load_randomization
from slipgym.config.level import load_level
from slipgym.config.load import read_overrides
from slipgym.config.pad import EFFECTS
from slipgym.envs.actions import ACTION_MODES, GUESS, Actions
from slipgym.envs.arguments import CommonArguments, fields, friction_part, one_of
from slipgym.envs.observer import Observer
from slipgym.envs.sensor_part import LOADED, layout_of
from slipgym.envs.simulation import Simulation
from slipgym.envs.values import DIFFERENCES
from slipgym.tasks import TASKS, Task, configure
from slipgym.tasks.configure import recorded

MakeSimulation = Callable[[Config, TaskConfig, Task, Any, Randomization], Simulation]


class Setup:
    """Builds configuration, actions, simulation and observer from all of `CommonArguments`.

    Attributes:
        randomization: Distributions that an episode is sampled from, those of the level in place.
        material: Name of the material, or "random".
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


_PLACES = {
    **{name: f"{own.group}.{name}" for name, own in DIFFERENCES.items()},
    **{name: f"contact.pad.{name}" for name in EFFECTS},
    **{name: f"contact.{name}" for name in ("stribeck_velocity", "speed_slope", "sigma_0", "pressure")},
    **{name: f"gripper.{name}" for name in ("lag", "dead_time", "stiction")},
    "slip_latency": "sensors.slip.latency_samples",
}
"""Field of the randomization -> key of the configuration that it takes the place of."""


def warn_of_drawn(
    overrides: Overrides | None, ranges: Ranges, settings: TaskConfig, task: str, material: str
) -> None:
    """Warn of keys that are drawn in a configuration given in part; nobody wrote each key of a whole one."""
    source, values = ("", {}) if overrides is None else read_overrides(overrides)
    if values.keys() >= Config.model_fields.keys():
        return
    places = {**_PLACES, "mu_c": f"tasks.{task}.friction_range"}
    drawn = {places[name]: f"the randomization or the level draws {name}" for name in places
             if getattr(ranges, name) is not None}  # fmt: skip
    if ranges.friction_by_area:
        drawn[places["load_exponent"]] = "friction_by_area takes it from the radius_exponent that is drawn"
    if material == "random" and (ranges.mu_c is not None or settings.friction_range is not None):
        for name in values.get("materials", {}):
            drawn[f"materials.{name}"] = f"its friction is drawn, unless material={name!r} is given"
    for key, why in drawn.items():
        if _has(values, key):
            warnings.warn(
                f"{source}: {key} has no effect unless randomization_scale is below 1: {why}", stacklevel=2
            )


def _has(values: Mapping[str, Any], key: str) -> bool:
    group, _, rest = key.partition(".")
    return group in values and (not rest or _has(values[group], rest))
