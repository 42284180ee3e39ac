"""The tasks, one file each."""

from slipgym.tasks.table import TASKS, find
from slipgym.tasks.task import Column, Task, Term

__all__ = ["TASKS", "Column", "Task", "Term", "find"]
