"""The paper's analyses and experiments, by one command each."""

from policies.reproduction.coupling import reproduce_coupling
from policies.reproduction.linear import reproduce_linear
from policies.reproduction.planar import reproduce_planar
from policies.reproduction.profile import reproduce_profile

__all__ = ["reproduce_coupling", "reproduce_linear", "reproduce_planar", "reproduce_profile"]
