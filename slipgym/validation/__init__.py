"""The acceptance figures: physics in the full PyBullet world, and the estimator on exact data."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from slipgym.validation.agreement import agreement
from slipgym.validation.breakaway import breakaway
from slipgym.validation.creep import creep
from slipgym.validation.distributed import distributed
from slipgym.validation.energy import energy
from slipgym.validation.estimation import estimation
from slipgym.validation.fall import fall
from slipgym.validation.figure import Figure
from slipgym.validation.halving import halving
from slipgym.validation.steady import steady

EXPERIMENTS: tuple[Callable[[], Iterator[Figure]], ...] = (
    creep,
    breakaway,
    steady,
    energy,
    halving,
    fall,
    agreement,
    distributed,
    estimation,
)
"""Each yields its figures; together about twenty seconds."""

__all__ = ["EXPERIMENTS", "Figure"]
