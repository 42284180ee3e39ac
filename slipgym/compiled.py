"""`compiled`: numba with a cache that notices a change in any file of slipgym.

A division by zero gives an infinity or a NaN, as in numpy, and not an exception: the check would keep
loops from running on several elements at once. Functions are compiled into their callers.
"""

from __future__ import annotations

from pathlib import Path

from estimator.caching import compiler

_HERE = Path(__file__).parent

compiled = compiler(_HERE, error_model="numpy", forceinline=True)
unlocked = compiler(_HERE, error_model="numpy", nogil=True, forceinline=True)
"""The same for what threads run side by side."""
compiled_sum = compiler(_HERE, error_model="numpy", fastmath={"reassoc"})
"""For a loop that sums: its additions may be taken in another order, which is what several elements at once
takes. The order is fixed when the function is compiled, so that equal input gives equal bits; a processor
with other vector instructions may round otherwise. Functions that it calls keep their own order."""
