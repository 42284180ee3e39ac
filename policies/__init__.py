"""Policies behind one `predict`: classic controllers, and what evaluates them.

import policies

policy = policies.make("linear_slip")
action, state = policy.predict(observation, state=None)
"""

from policies.registry import Policy, find, load, make, names

__all__ = ["Policy", "find", "load", "make", "names"]
