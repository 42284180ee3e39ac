"""Asks the processor for the memory of a state before it is needed.

The states of thousands of fingers do not fit into a processor's caches, and its own prefetcher follows streams,
not records of which a sample needs some lines each.
"""

from estimator._numba.caching import njit
from estimator._numba.memory import LINE, ask
from estimator.augmented.state import STATE
from estimator.augmented.timing import LAST

AHEAD = 4
"""Rows between the one that is updated and the one whose head is asked for."""


def _place(field: str) -> int:
    fields = STATE.fields
    assert fields is not None
    return fields[field][1]


SIZE = STATE.itemsize
HEAD, MOTION, END = _place("wrenches"), _place("spring"), _place("fallen")
WRENCHES, TWISTS, BUFFER = _place("wrenches"), _place("twists"), _place("buffer")


@njit(error_model="numpy")
def prefetch(states, i):
    """Asks for what row i needs beside its head, and for the head of a later row, be it there or not.

    Args:
        states: (n,) of dtype STATE.
        i: Row that is updated next.
    """
    later = (i + AHEAD) * SIZE
    for offset in range(0, HEAD, LINE):
        ask(states, later + offset)
    if i == 0:
        _tail(states, 0)
    if i + 1 < len(states):
        _tail(states, i + 1)


@njit(error_model="numpy")
def _tail(states, i):
    own, state = i * SIZE, states[i]
    ask(states, own + WRENCHES + 16 * (state.samples & LAST))
    ask(states, own + WRENCHES + 16 * ((state.samples - 3) & LAST))
    ask(states, own + TWISTS + 12 * (state.samples & LAST))
    ask(states, own + TWISTS + 12 * ((state.samples - 3) & LAST))
    if state.slipping or state.moved > 0:
        for offset in range(MOTION, END, LINE):
            ask(states, own + offset)
    else:
        ask(states, own + BUFFER + 8 * state.buffer_next)
