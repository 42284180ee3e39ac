"""Policies behind one `predict`: classic controllers, learned ones, and what evaluates them.

import policies

policy = policies.make("linear_slip")  # or policies.load("folder/of/a/learned/policy")
action, state = policy.predict(observation, state=None)
"""

from policies.registry import Policy, find, is_controller, load, make, modes, names

__all__ = ["Policy", "find", "is_controller", "load", "make", "modes", "names"]
