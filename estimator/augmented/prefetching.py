"""Prefetches the states of "adaptive".

A processor's caches do not hold the states of thousands of fingers, and a sample needs some lines of each.
"""

from typing import Any

from estimator._numba.caching import njit
from estimator._numba.memory import LINE, ask
from estimator.augmented.state import STATE

AHEAD = 4
"""Rows between the one that is updated and the one whose first fields are prefetched."""


_FIELDS: Any = STATE.fields
MOTION, END, BUFFER = (_FIELDS[name][1] for name in ("spring", "fallen", "buffer"))
SIZE = STATE.itemsize


@njit(error_model="numpy")
def prefetch(states, i):
    """Prefetches what a sample needs: the first fields of a later row, the other ones of the next row.

    Args:
        states: (n,) of dtype STATE.
        i: Row that is updated next.
    """
    for offset in range(0, MOTION, LINE):
        ask(states, (i + AHEAD) * SIZE + offset)
    for row in range(i + 1 if i > 0 else 0, min(i + 2, len(states))):
        if states[row].slipping or states[row].moved > 0:
            for offset in range(MOTION, END, LINE):
                ask(states, row * SIZE + offset)
        else:
            ask(states, row * SIZE + BUFFER + 8 * states[row].buffer_next)
