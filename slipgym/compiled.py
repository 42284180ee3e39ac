"""`compiled`: numba with a cache that notices a change in any file of slipgym."""

from __future__ import annotations

from pathlib import Path

from estimator.caching import compiler

_HERE = Path(__file__).parent

compiled = compiler(_HERE)
unlocked = compiler(_HERE, nogil=True)
"""The same for what threads run side by side."""
