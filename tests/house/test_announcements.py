"""What numba announces of its work reaches those who listen."""

import warnings

import numba
import numpy as np
import pytest
from numba.core import errors, event

from estimator._numba.quicker import quick_compiler


class _Listener(event.Listener):
    def __init__(self):
        self.heard = []

    def on_start(self, event):
        self.heard.append((event.kind, "start"))

    def on_end(self, event):
        self.heard.append((event.kind, "end"))


def _search(values, wanted):
    found, place = 0, 0
    while place < values.size:  # three edges lead back
        place += 1
        if values[place - 1] < 0.0:
            continue
        for k in range(3):
            if k == 2:
                continue
            found += values[place - 1] == wanted + k
        if found > 3:
            break
    return found, place


def test_loops_with_several_edges_back_are_compiled():
    values = np.array([1.0, -2.0, 2.0, 1.0, 3.0, 2.0, 2.0, 1.0])
    with quick_compiler():
        found = numba.njit(_search)(values, 1.0)
    assert found == _search(values, 1.0)


@pytest.mark.parametrize("kind", ["numba:run_pass", "numba:llvm_lock", "numba:compile"])
def test_a_listener_hears_what_numba_announces(kind):
    listener = _Listener()
    with quick_compiler(), event.install_listener(kind, listener):
        numba.njit(lambda x: x + 1.0)(1.0)
    assert len(listener.heard) > 1
    assert {(kind, "start"), (kind, "end")} == {*listener.heard}
    assert listener.heard[::2] != listener.heard[1::2]


def test_warnings_of_an_expression_are_seen():
    fixer = errors.WarningsFixer(errors.NumbaWarning)
    with (
        pytest.warns(errors.NumbaWarning, match="slow"),
        quick_compiler(),
        fixer.catch_warnings("file.py", 3),
    ):
        warnings.warn(errors.NumbaWarning("slow"), stacklevel=1)
