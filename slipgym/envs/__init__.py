"""The environments: a class for each task that comes with slipgym, `LinearSlipEnv` and so on.

`SlipEnv` is the base class of the scalar environments; the vector environments are
`slipgym.envs.vector_env.SlipVectorEnv`. `register_task` makes an environment of a task of your own.

The way of an action to the contact and back to an observation, file by file (below `slipgym/`):

1. `envs/slip_env.py` or `envs/vector_env.py`: Gymnasium's `step`. `envs/arguments.py` declares the keyword
   arguments, and `envs/setup.py` has built all parts from them.
2. `envs/actions.py` checks the action and turns it into a commanded grip force and a velocity of the wrist.
3. `envs/simulation.py` holds the arrays of all environments. Its two engines make the control steps:
   `envs/bullet_simulation.py` of one environment, `envs/planar_simulation.py` of thousands, in parts that
   `threads.py` hands out. `envs/control_step.py` has the stages of a control step, which both engines call in
   the same order; `envs/stages.py` compiles them.
4. Stage *begin*: `tasks/episode.py`, `tasks/disturbance.py` and the task's file script wrist and pushes.
5. The motion: `world/planar_engine.py`, or `world/bullet_engine.py` with PyBullet; both go through
   `world/substep.py` to the contact, `contact/coupled.py`.
6. Stage *measure*: `sensors/measure.py` reads the sensors of both fingers.
7. Stages *estimate* and *evaluate*: the estimator of each finger; `envs/estimates.py` merges both; the task's
   file computes reward, success and its columns. `envs/nan_guard.py` looks for numbers that are not finite.
8. Stages *look* and *report*: `envs/observation.py` writes the observation, `envs/infos.py` the info;
   `envs/readings.py` generates the functions that do from tables. `envs/observer.py` adds history and groups.

An episode begins in `envs/reset.py`, called from `Simulation.reset_rows`: `envs/randomizer.py` samples the
numbers that `envs/values.py` declares, `envs/sampling_kernels.py` makes initial conditions of them, and
`envs/reset_kernels.py` applies these to bodies, pads and sensors. `envs/reset_options.py` checks the seeds
and options that the `reset` of many environments gets.

States of environments: `envs/states.py`. Pages of the documentation: `envs/docstring.py`.
"""

from functools import cache
from typing import TYPE_CHECKING, Any

import gymnasium as gym

from slipgym.envs.docstring import docstring
from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS, register_id
from slipgym.tasks import TASKS, Task
from slipgym.tasks.configure import add

if TYPE_CHECKING:
    from slipgym.envs.vector_env import SlipVectorEnv

_CLASSES = tuple(entry_point.partition(":")[2] for entry_point in ENVIRONMENTS.values())

__all__ = ["SlipEnv", "SlipVectorEnv", *_CLASSES]  # pyright: ignore[reportUnsupportedDunderAll]


@cache
def environment(task: Task) -> type[SlipEnv]:
    """Return the class <name>Env with its docstring; every call returns the same class.

    Its module is `slipgym.envs` or, for a task of your own, the module of the task's `start`.

    Raises:
        ValueError: The task's page has an unknown section.
    """
    module = "slipgym.envs" if task.id in ENVIRONMENTS else task.module
    members = {"task": task, "__doc__": docstring(task), "__module__": module}
    return type(f"{task.name}Env", (SlipEnv,), members)


def register_task(task: Task) -> type[SlipEnv]:
    """Make a task of your own an environment, in this process.

    Bind the class that comes back to a name of the module that defines the task, <name>Env: Gymnasium looks
    for it there, and so does pickle. Once registered, a task is in `slipgym.tasks.TASKS`, and configuration,
    experiments, policies and pictures know it. Registering an id again replaces the task.

    Args:
        task: The task; its module is that of its `start`.

    Raises:
        ValueError: Another task has its name or key, or a part of the task is not valid; the message says
            which.
    """
    made = environment(task)
    add(task)
    gym.registry.pop(task.id, None)
    register_id(task.id, f"{made.__module__}:{made.__name__}")
    return made


def __getattr__(name: str) -> type[SlipEnv]:
    if name == "SlipVectorEnv":
        from slipgym.envs.vector_env import SlipVectorEnv

        found: Any = SlipVectorEnv
        return found
    if name in _CLASSES:
        return environment(TASKS[name.removesuffix("Env")])
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
