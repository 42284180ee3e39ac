"""Renders selected environments of a vector environment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from slipgym.envs.simulation import Simulation

SHOWN = 16
"""Largest number of environments that are all shown by default."""


class Pictures:
    """Renders the chosen environments; without rows all, or only the first if there are more than `SHOWN`.

    Raises:
        ValueError: `rows` is not a list of indices of environments.
    """

    def __init__(
        self,
        simulation: Simulation,
        mode: str | None,
        rows: Sequence[int] | None,
        size: Sequence[int] | None = None,
    ) -> None:
        self._renderers: dict[int, Any] = {}
        self._mode, self._begun = mode, set[int]()
        if mode is None:
            return
        from slipgym.rendering import Renderer

        if rows is None:
            rows = range(simulation.n if simulation.n <= SHOWN else 1)
        if not isinstance(rows, Sequence) or not rows:
            raise ValueError(f"render_rows = {rows!r} must be a list of at least one row")
        for row in rows:
            if isinstance(row, bool) or not isinstance(row, int) or not 0 <= row < simulation.n:
                raise ValueError(f"render_rows: {row!r} must be a whole number from 0 to {simulation.n - 1}")
            self._renderers[row] = Renderer(mode, simulation, row, size)

    def begin(self, rows: np.ndarray) -> None:
        """Update the renderers of environments (m,) after a reset."""
        for i in self._renderers.keys() & set(rows.tolist()) if self._renderers else ():
            self._renderers[i].begin()
            self._begun.add(i)

    def keep(self, active: np.ndarray) -> None:
        """Update the renderers of environments (n,) bool that have made a step."""
        for i, renderer in self._renderers.items():
            if active[i]:
                renderer.keep()

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Return a picture of each; None without a mode.

        Raises:
            RuntimeError: A chosen environment was never reset.
        """
        if self._mode is None:
            return None
        for row in self._renderers:
            if row not in self._begun:
                raise RuntimeError(f"call reset() first: environment {row} has no object yet")
        return tuple(renderer.render() for renderer in self._renderers.values())
