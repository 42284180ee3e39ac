"""Computes what supports the acceptance figures: other steps, contacts, pads and engines, exact laws."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from lab.validation.accelerated import accelerated
from lab.validation.agreement import agreement
from lab.validation.halving import halving
from lab.validation.patch_rate import patch_rate
from lab.validation.patch_steps import patch_steps
from lab.validation.patch_stick import patch_stick
from lab.validation.patch_surface import patch_surface
from lab.validation.patches import disc, distributed
from lab.validation.slides import slides
from lab.validation.soft import soft
from lab.validation.tilt import tilt
from slipgym.validation import Figure

EXPERIMENTS: tuple[Callable[[], Iterator[Figure]], ...] = (
    accelerated,
    halving,
    agreement,
    slides,
    patch_surface,
    patch_stick,
    patch_steps,
    patch_rate,
    tilt,
    disc,
    distributed,
    soft,
)
"""Each yields its figures."""

__all__ = ["EXPERIMENTS"]
