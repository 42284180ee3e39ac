"""Finds the class of a controller by its name, and makes controllers."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from estimator.reference import is_reference, referenced
from estimator.suggestions import asking, unknown
from policies.controllers.gains import GainPolicy, renamed

CLASSES = {
    "rotational_slip": "policies.controllers.rotational_slip:RotationalSlipPolicy",
    "hinge": "policies.controllers.hinge:HingePolicy",
    "constant_force": "policies.controllers.constant_force:ConstantForcePolicy",
    "planar_slip": "policies.controllers.planar_slip:PlanarSlipPolicy",
    "planar_slip_continuous": "policies.controllers.planar_slip_continuous:ContinuousPlanarSlipPolicy",
    "hold": "policies.controllers.hold:HoldPolicy",
    "fragile_hold": "policies.controllers.fragile_hold:FragileHoldPolicy",
    "carry": "policies.controllers.carry:CarryPolicy",
    "explore": "policies.controllers.explore:ExplorePolicy",
    "pivot_to": "policies.controllers.pivot_to:PivotToPolicy",
    "linear_slip": "policies.controllers.linear_slip:LinearSlipPolicy",
    "linear_slip_continuous": "policies.controllers.linear_slip_continuous:ContinuousLinearSlipPolicy",
    "linear_slip_leaps": "policies.controllers.linear_slip_leaps:LinearSlipLeapPolicy",
}
"""Name -> module:class; imported on first use."""


def is_controller(name: str) -> bool:
    """Whether a name stands for a class, as `find` takes it; the others are learned."""
    return name in CLASSES or is_reference(name)


def find(name: str, valid: Iterable[str] = tuple(CLASSES)) -> type[Any]:
    """The class of a controller.

    Args:
        name: A key of `CLASSES`, or "module:class" for one of your own: any class with a `predict`.
        valid: What to name as such in an error.

    Raises:
        ValueError: There is none.
    """
    if is_reference(name):
        policy = referenced(name)
        if not isinstance(policy, type) or not callable(getattr(policy, "predict", None)):
            raise ValueError(f"{name!r} is no policy: a class with a method predict")
        return policy
    if name not in CLASSES:
        raise ValueError(unknown("unknown policy", name, valid))
    return referenced(CLASSES[name])


def make(name: str, parameters: Mapping[str, Any], valid: Iterable[str] = tuple(CLASSES)) -> Any:
    """Makes a controller.

    Args:
        name: As for `find`.
        parameters: Arguments of its class.
        valid: See `find`.

    Raises:
        ValueError: The name or a parameter is unknown, or a value is not allowed.
    """
    policy = find(name, valid)
    if issubclass(policy, GainPolicy):
        parameters = renamed(parameters)
    refuse(name, parameters, parameters_of(policy))
    return policy(**parameters)


def parameters_of(policy: type[Any]) -> list[str]:
    """Names of the parameters that a policy's class is made with; single gains are among them."""
    own = inspect.signature(policy).parameters.values()
    names = [each.name for each in own if each.kind is not inspect.Parameter.VAR_KEYWORD]
    return [*policy.Gains.model_fields, *names] if issubclass(policy, GainPolicy) else names


def refuse(name: str, parameters: Mapping[str, Any], valid: Sequence[str]) -> None:
    """Raise ValueError for a parameter that a policy does not have."""
    for parameter in parameters:
        if parameter not in valid:
            known = ", ".join(valid) or "none, it is learned"
            said = f"unknown parameter {parameter!r} of policy {name!r}; valid: {known}"
            raise ValueError(asking(said, parameter, valid))
