"""Chooses the estimators of an environment, or their stand-in, and merges the estimates of both fingers."""

import math
from collections.abc import Mapping
from dataclasses import asdict, fields
from textwrap import shorten
from typing import Any

import numpy as np
from numba.core.errors import NumbaError

import estimator as estimators
from estimator._numba.entry_point import entry_point, update_signature
from estimator.estimate import COMMON_STATE
from estimator.registry import specification
from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.config.sensors import SensorsConfig
from slipgym.sensors.markers import COUNT
from slipgym.tasks.compile import first_lines

LATENCY = "velocity_delay"
"""Parameter of an estimator: the latency of the slip velocity."""
STATED = (LATENCY, "unmeasured", "sd_force", "sd_normal", "sd_torque", "sd_gain", "sd_zero", "nominal_delay")
"""Parameters that a preset of the sensors states for an estimator."""


def chosen_estimator(choice: str | Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Return the estimator's name and parameters; None for none.

    Those of STATED are left out unless the user gave them.
    """
    if choice is None:
        return None
    if isinstance(choice, str):
        choice = {"name": choice}
    if not isinstance(choice, Mapping) or not isinstance(choice.get("name"), str):
        raise ValueError(
            f"estimator = {choice!r} must be a name, a mapping with a name, or None; "
            f"valid: {', '.join(estimators.names())}"
        )
    given = dict(choice)
    name = given.pop("name")
    parameters = asdict(specification(name).parameters.create(**given))
    return {"name": name, **{key: parameters[key] for key in parameters if key in given or key not in STATED}}


def _data_sheet(sensors: SensorsConfig) -> dict[str, float]:
    """What is not measured, and deviations, of sensors other than those in each finger."""
    force, motor, markers = sensors.force_torque, sensors.motor, sensors.markers
    if sensors.usual:
        return {}
    if sensors.place != "fingers":
        return {
            "unmeasured": 1 if sensors.place == "wrist" else 2,
            "sd_force": max(force.noise_tangential, 1e-3),
            "sd_normal": max(math.hypot(motor.noise, motor.resolution), 1e-3),
            "sd_torque": max(force.noise_torque, 1e-5),
            "sd_gain": math.hypot(motor.gain_error / math.sqrt(3.0), motor.friction),
            "sd_zero": max(force.bias_tangential, 1e-3),
        }
    stated = {"sd_normal": max(force.noise_normal, 1e-3), "nominal_delay": sensors.slip.latency_samples}
    if markers is None:
        return stated
    stated["sd_force"] = max(math.sqrt(COUNT) * markers.noise / markers.compliance, 1e-3)
    stated["sd_gain"] = math.hypot(markers.gain_error, markers.normal_error) / math.sqrt(3.0)
    return stated


_ANY = np.dtype(COMMON_STATE, align=True)


@entry_point(_ANY, _ANY)
def leave(states, parameters, t, wrenches, twists, estimates):
    """Changes nothing: the update of estimators with `estimator=None`."""


def make_estimators(choice: dict[str, Any] | None, config: Config, n: int) -> estimators.BatchEstimator:
    """The estimators of n fingers, from `chosen_estimator`, with what they know of the sensors.

    That is the latency that the preset states and, of grippers as labs own them, the data sheet; not what an
    episode samples.

    Without a choice they state the default's start values all the time: `leave` updates them.
    """
    if choice is not None:
        known = {field.name for field in fields(specification(choice["name"]).parameters)}
        stated = {LATENCY: config.sensors.slip.latency_samples, **_data_sheet(config.sensors)}
        own = {name: value for name, value in stated.items() if name in known}
        return estimators.make_batch(n=n, **{**own, **choice})
    start = estimators.make_batch(estimators.DEFAULT, 1).estimates[0]
    stated = {f"{name}0": start[name] for name in ("mu_s", "mu_c", "r")}
    return estimators.make_batch("rls", n, **stated)


def compiled_update(fingers: estimators.BatchEstimator) -> tuple[Any, Any]:
    """The `update_batch` of estimators, and the signature that it is compiled for.

    Raises:
        ValueError: That of an estimator of one's own does not compile.
    """
    update = specification(fingers.name).update_batch
    signature = update_signature(fingers.states.dtype, fingers.parameters_array.dtype)
    try:
        if signature.args not in update.overloads:
            update.compile(signature)
    except (AttributeError, KeyError, NumbaError, RuntimeError, TypeError) as error:
        raise ValueError(
            f"estimator {fingers.name!r}: update_batch must be a function of numba.njit without a signature "
            f"of its own: {_said(error)}"
        ) from None
    return update, signature


def _said(error: Exception) -> str:
    """What is wrong, of an error of numba with its place; KeyError(name): an array without such a field."""
    if isinstance(error, KeyError):
        return f"no array has a field {error.args[0]!r}"
    if not isinstance(error, NumbaError):
        return str(error)
    loc = getattr(error, "loc", None)
    return ("" if loc is None else f"{loc.filename}:{loc.line}: ") + shorten(first_lines(error), 300)


UNCHANGED = leave, update_signature(_ANY, _ANY)
"""In place of `compiled_update` with `estimator=None`."""


@compiled
def weighted_mean(a, b, weight_a, weight_b):
    """Mean of two values by their weights; the plain mean if both weights are 0."""
    total = weight_a + weight_b
    return (a * weight_a + b * weight_b) / total if total > 0.0 else 0.5 * (a + b)


@compiled
def mean_mu_s(first, second):
    """mu_s of both fingers, weighted by confidence."""
    return weighted_mean(first.mu_s, second.mu_s, first.confidence_mu_s, second.confidence_mu_s)


@compiled
def merged_mu_c(first, second):
    """mu_c of both fingers; as in `estimator.sample.publish`, a start value yields to a measured mu_s."""
    mu_c = weighted_mean(first.mu_c, second.mu_c, first.confidence_mu_c, second.confidence_mu_c)
    if first.confidence_mu_c + second.confidence_mu_c > 0.0:
        return mu_c
    if first.confidence_mu_s + second.confidence_mu_s > 0.0:
        return min(mu_c, mean_mu_s(first, second))
    return mu_c


@compiled
def merged_mu_s(first, second):
    """mu_s of both fingers, at least their mu_c: the weights differ, so that the means may cross."""
    return max(mean_mu_s(first, second), merged_mu_c(first, second))
