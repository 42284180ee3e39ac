"""The paper's analyses and experiments, by one command each."""

from policies.research.reproduction.coupling import reproduce_coupling
from policies.research.reproduction.linear import reproduce_linear
from policies.research.reproduction.planar import reproduce_planar
from policies.research.reproduction.profile import reproduce_profile
from policies.research.reproduction.surface import reproduce_surface

__all__ = [
    "reproduce_coupling",
    "reproduce_linear",
    "reproduce_planar",
    "reproduce_profile",
    "reproduce_surface",
]
