"""The tasks, one file each."""

from slipgym.tasks import hold, linear_slip
from slipgym.tasks.task import Task

TASKS: dict[str, Task] = {task.name: task for task in (linear_slip.TASK, hold.TASK)}

__all__ = ["TASKS", "Task"]
