"""The tasks, one file each."""

from slipgym.tasks import hinge, hold, linear_slip, planar_slip, rotational_slip
from slipgym.tasks.task import Task

TASKS: dict[str, Task] = {
    module.TASK.name: module.TASK for module in (linear_slip, rotational_slip, hinge, planar_slip, hold)
}

__all__ = ["TASKS", "Task"]
