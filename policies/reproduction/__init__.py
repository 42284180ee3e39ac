"""The paper's analyses and experiments, by one command each."""

from policies.reproduction.coupling import reproduce_coupling
from policies.reproduction.profile import reproduce_profile

__all__ = ["reproduce_coupling", "reproduce_profile"]
