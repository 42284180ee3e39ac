"""Computes the acceptance figures: physics with both engines, and the estimator on exact data."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from slipgym.validation.accelerated import accelerated
from slipgym.validation.agreement import agreement
from slipgym.validation.breakaway import breakaway
from slipgym.validation.creep import creep
from slipgym.validation.disc import disc
from slipgym.validation.distributed import distributed
from slipgym.validation.energy import energy
from slipgym.validation.estimation import estimation
from slipgym.validation.fall import fall
from slipgym.validation.figure import Figure
from slipgym.validation.halving import halving
from slipgym.validation.patch_rate import patch_rate
from slipgym.validation.patch_steps import patch_steps
from slipgym.validation.patch_stick import patch_stick
from slipgym.validation.patch_surface import patch_surface
from slipgym.validation.planar import planar, slides
from slipgym.validation.soft import soft
from slipgym.validation.steady import steady
from slipgym.validation.tilt import tilt

EXPERIMENTS: tuple[Callable[[], Iterator[Figure]], ...] = (
    creep,
    breakaway,
    accelerated,
    steady,
    energy,
    halving,
    fall,
    agreement,
    planar,
    slides,
    disc,
    soft,
    distributed,
    patch_surface,
    patch_stick,
    patch_steps,
    patch_rate,
    tilt,
    estimation,
)
"""Each yields its figures; together about a hundred seconds."""

__all__ = ["EXPERIMENTS", "Figure"]
