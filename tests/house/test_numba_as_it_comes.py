"""Nothing in numba or llvmlite is replaced: not by the import of slipgym, and not while it compiles."""

import subprocess
import sys

CODE = """
import sys
import tempfile
import types
import numba, numba.core.event, numba.core.codegen, numba.core.compiler
import numba.np.arrayobj, llvmlite.ir, llvmlite.binding

def contents():
    found = {}
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] not in ("numba", "llvmlite") or not isinstance(module, types.ModuleType):
            continue
        for key, value in vars(module).items():
            if isinstance(value, type) and value.__module__.partition(".")[0] in ("numba", "llvmlite"):
                for inner, member in list(vars(value).items()):
                    if callable(member) or isinstance(member, (property, classmethod, staticmethod)):
                        found[name, key, inner] = member
            if callable(value):
                found[name, key] = value
    return found

numba.njit(lambda x: max(x, 1.0) + 1.0)(2.0)  # numba completes itself when it first compiles
numba.config.CACHE_DIR = tempfile.mkdtemp()
before, replaced = contents(), set()

class Listener(numba.core.event.Listener):
    compiled = 0

    def on_start(self, event):
        self.compiled += 1
        now = contents()
        replaced.update(key for key in before if now.get(key) is not before[key])

    def on_end(self, event):
        self.on_start(event)

listener = Listener()
numba.core.event.register("numba:compile", listener)
from estimator._numba.caching import njit
from slipgym._numba.compiled import compiled

@njit
def inner(x, y):
    return max(x, y) * 2.0

@compiled
def outer(values):
    return inner(values[0], values[1]) + values.sum()

import numpy as np
assert outer(np.ones(2)) == 4.0
assert listener.compiled > 1
print(len(replaced), *sorted(".".join(key) for key in replaced))
"""


def test_no_name_of_numba_is_replaced():
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["0"], done.stdout
