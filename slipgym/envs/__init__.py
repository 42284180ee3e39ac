"""The environments: a class for each task that comes with slipgym, `LinearSlipEnv` and so on.

`SlipEnv` is the base class of the scalar environments; the vector environments are
`slipgym.envs.vector_env.SlipVectorEnv`.
"""

from typing import TYPE_CHECKING, Any

from slipgym.envs.environment import environment
from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import TASKS

if TYPE_CHECKING:
    from slipgym.envs.vector_env import SlipVectorEnv

_CLASSES = tuple(entry_point.partition(":")[2] for entry_point in ENVIRONMENTS.values())

__all__ = ["SlipEnv", "SlipVectorEnv", *_CLASSES]  # pyright: ignore[reportUnsupportedDunderAll]


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
