"""The paper's analyses and experiments, by one command each."""

from policies.reproduction.coupling import reproduce_coupling
from policies.reproduction.linear import reproduce_linear
from policies.reproduction.planar import reproduce_planar
from policies.reproduction.profile import reproduce_profile
from policies.reproduction.surface import reproduce_surface

__all__ = [
    "reproduce_coupling",
    "reproduce_linear",
    "reproduce_planar",
    "reproduce_profile",
    "reproduce_surface",
]
