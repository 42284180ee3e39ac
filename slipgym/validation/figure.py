"""`Figure`, an acceptance figure: a measured value and its bound."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """A measured size that must not exceed a bound."""

    name: str
    """Name of the figure."""
    bound: float
    """Largest value allowed."""
    measured: float
    """Value found."""
    unit: str
    """Unit of both."""

    @property
    def ok(self) -> bool:
        """Whether the bound holds; not so for NaN."""
        return self.measured <= self.bound
