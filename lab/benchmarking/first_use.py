"""Measures the first use after an installation: what compiling costs, and where its time goes.

Every case runs in fresh processes with an empty folder of programs. Times are CPU time of the process, its
imports included. Numba announces its passes; the time within a pass, less that of the passes and of LLVM
within it, is the pass's own. To record them takes time of its own: a process that records nothing gives the
time in all, a second one the parts.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from contextlib import nullcontext
from time import process_time
from typing import Any

from numba.core import event

from slipgym.benchmarking.report import Figure

CASES = {"PyBullet": "bullet", "batch": "batch"}
"""Case -> its engine."""
PASSES = {"nopython_type_inference": "type inference", "native_lowering": "lowering"}
"""Pass of numba -> part that it is reported as; the others are "other passes"."""
PARTS: tuple[str, ...] = "type inference", "lowering", "other passes", "LLVM"
OTHER_TASK, OTHER_ESTIMATOR = "slipgym/Hold-v0", "disc"
_TRANSLATION = "native_lowering"
_KINDS = "numba:run_pass", "numba:llvm_lock"


class Compilation(event.Listener):
    """Records what numba compiles within a `with` statement.

    Attributes:
        spent: CPU time by part [s], see `PARTS`.
        functions: Names of the functions, each once for every signature.
    """

    def __init__(self) -> None:
        self.spent: dict[str, float] = dict.fromkeys(PARTS, 0.0)
        self.functions: list[str] = []
        self._open: list[str] = []
        self._since = 0.0

    def __enter__(self) -> Compilation:
        for kind in _KINDS:
            event.register(kind, self)
        return self

    def __exit__(self, *_: object) -> None:
        for kind in _KINDS:
            event.unregister(kind, self)

    def on_start(self, event: Any) -> None:
        """A pass, or a call of LLVM, begins."""
        self._charge()
        llvm = event.kind == "numba:llvm_lock"
        self._open.append("LLVM" if llvm else PASSES.get(_name(event), "other passes"))

    def on_end(self, event: Any) -> None:
        """It ends."""
        self._charge()
        self._open.pop()
        if event.kind == "numba:run_pass" and _name(event) == _TRANSLATION:
            self.functions.append(f"{event.data['module']}.{event.data['qualname']}")

    def _charge(self) -> None:
        now = process_time()
        if self._open:
            self.spent[self._open[-1]] += now - self._since
        self._since = now


def _name(event: Any) -> str:
    """Name of a pass; numba appends that of the function."""
    return event.data["name"].split()[0]


def first_use(env_id: str) -> list[Figure]:
    """First steps, then those with another task and another estimator, of all `CASES`.

    Args:
        env_id: Id of the environment.
    """
    figures: list[Figure] = []
    for case, engine in CASES.items():
        figures += _figures(case, measured(engine, env_id))
    return figures


def steps(engine: str, env_id: str, recorded: bool) -> list[dict[str, Any]]:
    """Make this process's first step, then one of another task and one with another estimator.

    Args:
        engine: One of `CASES`.
        env_id: Id of the environment.
        recorded: Whether the parts are recorded.

    Returns:
        Of each: CPU time in all and of the parts [s], functions as in `Compilation`.
    """
    before, found = 0.0, []
    other = OTHER_TASK if env_id != OTHER_TASK else "slipgym/LinearSlip-v0"
    for one, arguments in ((env_id, {}), (other, {}), (env_id, {"estimator": OTHER_ESTIMATOR})):
        record = Compilation()
        with record if recorded else nullcontext():
            _step(engine, one, arguments)
        now = process_time()
        found.append({"seconds": now - before, **record.spent, "functions": record.functions})
        before = now
    return found


def _step(engine: str, env_id: str, arguments: dict[str, Any]) -> None:
    import gymnasium as gym

    if engine == "batch":
        envs = gym.make_vec(f"slipgym:{env_id}", num_envs=2, **arguments)
        envs.reset(seed=0)
        envs.step(envs.action_space.sample())
        envs.close()
    else:
        env = gym.make(f"slipgym:{env_id}", **arguments)
        env.reset(seed=0)
        env.step(env.action_space.sample())
        env.close()


def measured(engine: str, env_id: str) -> list[dict[str, Any]]:
    """`steps` of a process that records nothing, with the parts, functions and time "recorded" of another."""
    plain, recorded = (_in_process(engine, env_id, on) for on in (False, True))
    return [
        {**parts, "seconds": time["seconds"], "recorded": parts["seconds"]}
        for time, parts in zip(plain, recorded, strict=True)
    ]


def _in_process(engine: str, env_id: str, recorded: bool) -> list[dict[str, Any]]:
    """`steps` in a new process with an empty folder of programs."""
    code = "import sys, json; from lab.benchmarking import first_use as f; "
    code += f"print(json.dumps(f.steps(*sys.argv[1:], {recorded})))"
    command = [sys.executable, "-c", code, engine, env_id]
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def _figures(case: str, found: list[dict[str, Any]]) -> list[Figure]:
    """Figures of a case.

    Args:
        case: Its name.
        found: What `steps` returned.
    """
    first, task, estimator = found
    functions = first["functions"]
    again = len(functions) - len({*functions})
    rest = first["recorded"] - sum(first[part] for part in PARTS)
    figures = [
        Figure(f"first step, {case}: CPU time", first["seconds"], "s"),
        Figure(f"first step, {case}: CPU time with its parts recorded", first["recorded"], "s"),
        *(Figure(f"first step, {case}: {part}", first[part], "s") for part in PARTS),
        Figure(f"first step, {case}: imports, hashing, storing, the step", rest, "s"),
        Figure(f"first step, {case}: functions compiled", len(functions), "-"),
        Figure(f"first step, {case}: of them for another signature", again, "-"),
    ]
    for name, step in (("another task", task), (f'then "{OTHER_ESTIMATOR}"', estimator)):
        figures += [
            Figure(f"{name}, {case}: CPU time", step["seconds"], "s"),
            Figure(f"{name}, {case}: functions compiled", len(step["functions"]), "-"),
        ]
    return figures
