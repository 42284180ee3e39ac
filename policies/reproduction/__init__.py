"""The paper's analyses and experiments, by one command each."""

from policies.reproduction.coupling import reproduce_coupling

__all__ = ["reproduce_coupling"]
