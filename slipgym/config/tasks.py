"""What every task can be told; its own settings stand in its file in slipgym/tasks/."""

from typing import TYPE_CHECKING, Any

from pydantic import Field

from slipgym.config.base import Frozen, Positive, PositiveInterval
from slipgym.config.hardware import ObjectConfig


class TaskConfig(Frozen):
    """What every task has."""

    initial_force: Positive = Field(description="Force per finger at reset [N]")
    object: ObjectConfig | None = Field(description="The object of this task; null: the common one [-]")
    mass_range: PositiveInterval | None = Field(
        description="The object's mass is drawn from this range; null: the object's own [kg]"
    )
    radius: Positive | None = Field(
        description="Radius r of the equivalent rim contact in this task, also nominal; null: the common [m]"
    )
    reward: Frozen = Field(description="Scales of the reward terms [-]")


class TasksConfig(Frozen):
    """Parameters of the tasks, one group each, by their keys; `config_model` adds the groups."""

    if TYPE_CHECKING:

        def __getattr__(self, key: str) -> Any: ...
