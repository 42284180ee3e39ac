"""Prefetches rows of arrays: asks the processor for their memory before it is needed.

The records of thousands of environments do not fit into a processor's caches, and its own prefetcher follows
streams, not records of which a step needs some lines each.
"""

from __future__ import annotations

import numpy as np

from estimator._numba.memory import LINE, ask
from slipgym._numba.compiled import DISABLED, unlocked

HEAD = 704
"""Bytes of a record that are prefetched. In longer records, fields that most steps do not need come last."""
_ENABLED = "prefetch" not in DISABLED


@unlocked
def fetch(array: np.ndarray, first: int, stop: int) -> None:
    """Prefetch rows of records, (n,) or (n, 2), from `first` to before `stop`, as far as there are any.

    An array of the first bytes of records, (n,), stands for them.
    """
    if not _ENABLED:
        return
    row, record = array.strides[0], array.strides[array.ndim - 1]
    for start in range(first * row, min(stop, array.shape[0]) * row, record):
        for offset in range(start, start + min(HEAD, record), LINE):
            ask(array, offset)
