"""`compiled`: numba with a cache that notices a change in any file of slipgym.

A division by zero gives an infinity or a NaN, as in numpy, and not an exception; functions are compiled into
their callers. Both make a friction step a fifth cheaper.
"""

from __future__ import annotations

from pathlib import Path

from estimator.caching import compiler

compiled = compiler(Path(__file__).parent, error_model="numpy", forceinline=True)
