"""The paper's analyses and experiments, by one command each."""

from lab.reproduction.coupling import reproduce_coupling
from lab.reproduction.linear import reproduce_linear
from lab.reproduction.planar import reproduce_planar
from lab.reproduction.profile import reproduce_profile
from lab.reproduction.surface import reproduce_surface

__all__ = [
    "reproduce_coupling",
    "reproduce_linear",
    "reproduce_planar",
    "reproduce_profile",
    "reproduce_surface",
]
