"""The package `estimator`, for those who look for it under slipgym: `from slipgym.estimator import make`."""

from slipgym.beside import under_slipgym

__getattr__, __dir__ = under_slipgym("estimator")
