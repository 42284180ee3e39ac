"""Computes the acceptance figures of the physics."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from slipgym.validation.bench import Figure
from slipgym.validation.breakaway import breakaway
from slipgym.validation.creep import creep
from slipgym.validation.energy import energy, fall
from slipgym.validation.steady import steady


def planar() -> Iterator[Figure]:
    """The figures of the PyBullet world, in the planar world alone."""
    for experiment in (creep, breakaway, steady, energy, fall):
        for figure in experiment(engine="planar"):
            yield replace(figure, name=f"planar: {figure.name}")


EXPERIMENTS: tuple[Callable[[], Iterator[Figure]], ...] = (creep, breakaway, steady, energy, fall, planar)
"""Each yields its figures."""

__all__ = ["EXPERIMENTS", "Figure"]
