"""The package `policies`, for those who look for it under slipgym: `from slipgym.policies import make`."""

from slipgym.beside import under_slipgym

__getattr__, __dir__ = under_slipgym("policies")
