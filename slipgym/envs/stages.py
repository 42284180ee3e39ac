"""Compiles the stages of a control step, for both engines: types, programs, pointers to them."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from functools import cache, cached_property, partial
from typing import Any, get_args, get_type_hints

import numpy as np
from numba import types

from slipgym._numba.compiled import patience, unlocked
from slipgym._numba.fixed import FixedType, entry_point
from slipgym._numba.generate import generate
from slipgym._numba.pointers import Known, Pointer
from slipgym.envs import control_step
from slipgym.envs.actions import COMPONENT
from slipgym.envs.control_step import BYTES, F2, F3, BatchState, array
from slipgym.envs.infos import InfoBuffer
from slipgym.envs.nan_guard import note
from slipgym.envs.observation import ObservationBuffers
from slipgym.envs.reset_kernels import HARDWARE, START, equip_rows, open_episodes
from slipgym.envs.values import VALUES
from slipgym.tasks.compile import explained

WHOLE, WHOLES, FLAGS = types.int64, array(types.int64), array(types.boolean)
_SINGLE = array(types.float32)
_TYPES = {name: get_args(hint)[1] for name, hint in get_type_hints(BatchState, include_extras=True).items()}
STATE = types.NamedTuple([*_TYPES.values()], BatchState)
"""Type of a `BatchState`."""
ACTION = types.Tuple([F2, array(COMPONENT), FLAGS])
"""Type of actions, their meaning, and which rows are active."""
_LOOK = [WHOLES, F2, _SINGLE, _SINGLE, WHOLES, array(types.float32, 2), WHOLES]
BUFFERS = types.NamedTuple(_LOOK, ObservationBuffers)
"""Type of `ObservationBuffers`."""
INFOS = types.NamedTuple([F2, array(types.boolean, 2), F2], InfoBuffer)
"""Type of an `InfoBuffer`."""
VALUES_TYPE = array(VALUES)
"""Type of VALUES (m,)."""
FRESH = types.Tuple([BYTES, _TYPES["estimates"], types.boolean])
"""Type of initial states of the estimators, as bytes, estimates, and whether there are estimators."""
_HEADS = array(types.uint8, 1, "A")
SCRIPT_WRIST = types.void(_TYPES["episodes"], _TYPES["worlds"])
EVALUATE_STEP = types.void(_TYPES["episodes"], _TYPES["worlds"], _TYPES["fingers"], F2)
UPDATE = types.void(_HEADS, _HEADS, types.float64, F2, F2, _TYPES["estimates"])
"""Signature of an estimator's update, the same for all: its records are given by their first bytes."""


@cache
def _forward(count: int) -> Any:
    """Compiled function that calls one, which is passed as a pointer, with so many arguments."""
    names = [f"a{k}" for k in range(count)]
    body, doc = [f"return function({', '.join(names)})"], "Call `function`."
    return generate(f"_forward_{count}", ["function", *names], body, {}, unlocked, __file__, doc)


class Program:
    """A `pointed` function compiled for one signature.

    Attributes:
        known: Type of the pointer.
        pointer: For other programs.
    """

    def __init__(self, function: Any, signature: Any) -> None:
        function.compile(signature)
        self.known, self.pointer = Known(signature), Pointer(function, signature)
        self._arguments = signature.args

    def call(self, *arguments: Any) -> Any:
        """Call it from Python, which compiles a program for that at first."""
        return self._entry(self.pointer, *arguments)

    @cached_property
    def _entry(self) -> Callable[..., Any]:
        return entry_point(_forward(len(self._arguments)), (self.known, *self._arguments))


def cells_type(ndim: int) -> Any:
    """Type of `slipgym.world.plant.Plant.cells` with so many dimensions, 0 for None."""
    return array(types.float64, ndim) if ndim else types.none


Linked = namedtuple(
    "Linked", "script_wrist evaluate_step update begin measure estimate evaluate look report note equip open"
)
"""Pointers to the functions that a program of an engine calls, or their types: two of the task, that of the
estimator, those of `control_step`, `nan_guard.note`, `equip_rows` and `open_episodes` of `reset_kernels`."""


class Stages:
    """The stages that both engines have in common, compiled for a task, an estimator, sensors and contacts.

    `update` is from `slipgym.envs.estimates.compiled_update`, `force_torque` the sensors' dtype; `cells` has
    the dimensions of `slipgym.world.plant.Plant.cells`, 0 for None.

    Attributes:
        linked: Pointers to them, for programs.
        kind: Type of `linked`.
        calls: The programs by name, called from Python with all their arguments.
        look_at: `slipgym.envs.control_step.look_at` without its first argument.
    """

    def __init__(self, task: Any, update: tuple[Any, Any], force_torque: np.dtype, cells: int) -> None:
        wrist, judge, learn = Known(SCRIPT_WRIST), Known(EVALUATE_STEP), Known(UPDATE)
        sensors, flags, rows = array(force_torque, 2), array(types.boolean, 2), (WHOLE, WHOLE)
        arguments = array(START), VALUES_TYPE, array(HARDWARE), F3, STATE, cells_type(cells), sensors
        void = types.void
        signatures = {
            "begin": (control_step.begin, void(wrist, STATE, ACTION, *rows)),
            "measure": (control_step.measure_rows, void(STATE, cells_type(cells), sensors, *rows)),
            "estimate": (control_step.estimate, void(learn, STATE, *rows)),
            "evaluate": (control_step.evaluate, void(judge, STATE, *rows)),
            "look": (control_step.look, void(STATE, BUFFERS, *rows)),
            "report": (control_step.report, void(STATE, F2, flags, *rows)),
            "note": (note, WHOLE(F2, WHOLE, STATE, WHOLE)),
            "equip": (equip_rows, void(*arguments)),
            "open": (open_episodes, void(learn, array(START), FRESH, STATE, sensors, F2)),
        }
        programs = {}
        with patience(f"the control step of {task.name}", len(signatures)) as one_more:
            for name, each in signatures.items():
                programs[name] = Program(*each)
                one_more()
            self.calls = {name: program.call for name, program in programs.items()}
            with explained(task):
                task.script_wrist.compile(SCRIPT_WRIST)
                task.evaluate_step.compile(EVALUATE_STEP)
            self.linked = Linked(
                Pointer(task.script_wrist, SCRIPT_WRIST),
                Pointer(task.evaluate_step, EVALUATE_STEP),
                Pointer(*update),
                **{name: program.pointer for name, program in programs.items()},
            )
            known = {name: program.known for name, program in programs.items()}
            self.kind = types.NamedTuple([*Linked(wrist, judge, learn, **known)], Linked)
            look_at = entry_point(control_step.look_at, (known["look"], WHOLES, FixedType(STATE), BUFFERS))
        self.look_at = partial(look_at, self.linked.look)
        self.report, self.note = self.calls["report"], self.calls["note"]


@cache
def compiled_stages(task: Any, update: tuple[Any, Any], force_torque: np.dtype, cells: int) -> Stages:
    """`Stages`, the same for the same arguments."""
    return Stages(task, update, force_torque, cells)
