"""`compiled`: numba with a cache that notices a change in any file of slipgym."""

from __future__ import annotations

from pathlib import Path

from estimator.caching import compiler

compiled = compiler(Path(__file__).parent, error_model="numpy", forceinline=True)
