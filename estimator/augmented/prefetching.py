"""Asks the processor for the memory of a state before it is needed.

The states of thousands of fingers do not fit into a processor's caches, and its own prefetcher follows streams,
not records of which a sample needs some lines each.
"""

from estimator._numba.caching import njit
from estimator._numba.memory import LINE, ask
from estimator.augmented.state import STATE

AHEAD = 4
"""Rows between the one that is updated and the one whose head is asked for."""


def _place(field: str) -> int:
    fields = STATE.fields
    assert fields is not None
    return fields[field][1]


SIZE, MOTION, END, BUFFER = STATE.itemsize, _place("spring"), _place("fallen"), _place("buffer")


@njit(error_model="numpy")
def prefetch(states, i):
    """Asks for what a sample needs of rows i and after it, be they there or not.

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
