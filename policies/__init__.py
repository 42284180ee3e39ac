"""Policies behind one `predict`: classic controllers, learned ones, and what evaluates and trains them.

import policies

policy = policies.make("linear_slip")  # or policies.load("folder/of/a/learned/policy")
action, state = policy.predict(observation, state=None)
"""

from typing import TYPE_CHECKING, Any

from policies.controllers.table import is_controller
from policies.registry import Policy, check_estimates, find, load, make, modes, names

if TYPE_CHECKING:
    from policies.training.adapter import make_vec_env

__all__ = [
    "Policy",
    "check_estimates",
    "find",
    "is_controller",
    "load",
    "make",
    "make_vec_env",
    "modes",
    "names",
]


def __getattr__(name: str) -> Any:
    """`make_vec_env` needs the extra "train", which nothing else here does."""
    if name != "make_vec_env":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from policies.training.adapter import make_vec_env

    return make_vec_env
