"""The tasks, one file each."""

from slipgym.config.task import Option, TaskConfig, setting
from slipgym.tasks.check import check
from slipgym.tasks.configure import TASKS, configure, find
from slipgym.tasks.task import Column, Task, Term, event, term

__all__ = [
    "TASKS",
    "Column",
    "Option",
    "Task",
    "TaskConfig",
    "Term",
    "check",
    "configure",
    "event",
    "find",
    "setting",
    "term",
]
