"""The environments: a class for each task that comes with slipgym, `LinearSlipEnv` and so on."""

from slipgym.envs.environment import environment
from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import TASKS


def __getattr__(name: str) -> type[SlipEnv]:
    task = TASKS.get(name.removesuffix("Env"))
    if task is None or task.id not in ENVIRONMENTS or not name.endswith("Env"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return environment(task)
