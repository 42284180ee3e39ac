"""Loads an estimator, and says why that takes so long where it has to be compiled."""

from estimator.registry import specification
from slipgym._numba.compiled import patience


def ready(estimator: str) -> None:
    """Load an estimator by its name, so that its first use is quick."""
    with patience(f"the estimator {estimator}"):
        specification(estimator)
