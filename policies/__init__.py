"""Policies behind one `predict`: classic controllers, and what evaluates and trains them.

import policies

policy = policies.make("linear_slip")
action, state = policy.predict(observation, state=None)
"""

from typing import TYPE_CHECKING, Any

from policies.registry import Policy, find, load, make, names

if TYPE_CHECKING:
    from policies.training.adapter import make_vec_env

__all__ = ["Policy", "find", "load", "make", "make_vec_env", "names"]


def __getattr__(name: str) -> Any:
    """`make_vec_env` needs the extra "train", which nothing else here does."""
    if name != "make_vec_env":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from policies.training.adapter import make_vec_env

    return make_vec_env
