from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from slipgym.tasks import TASKS, configure
from slipgym.tasks.episode import EPISODE
from slipgym.world.records import FINGER, WORLD


class Hand:
    """A task's functions on states made by hand."""

    def __init__(self, name: str, **options: Any) -> None:
        self.task = TASKS[name]
        self.episodes, self.worlds = np.zeros(1, EPISODE), np.zeros(1, WORLD)
        self.fingers = np.zeros((1, 2), FINGER)
        self.fingers["contact_force"] = self.fingers["force"] = 5.0
        self.columns = np.zeros((1, len(self.task.columns)))
        self.episode, self.world = self.episodes[0], self.worlds[0]
        self.episode["step_time"], self.episode["force_max"] = 1.0 / 120.0, 25.0
        self.episode["reach"] = 0.1, 0.1
        self.episode["wrist_speed_max"], self.episode["wrist_pitch_rate_max"] = 0.5, 3.0
        self.episode["scales"] = 1.0
        parsed = self.task.options.parse(options)
        self.settings = parsed.applied_to(configure(self.task)[1])
        self.task.start(self.settings, parsed, np.random.default_rng(0), self.episode)

    def evaluate(self, step: int, **world: Any) -> dict[str, float]:
        """Reward terms before scaling, of a step in a state; dense ones are limited to [-1, 1]."""
        self.episode["step"] = step
        for field, value in world.items():
            self.world[field] = value
        self.task.evaluate_step(self.episodes, self.worlds, self.fingers, self.columns)
        paid = zip(self.task.terms, self.episode["terms"].tolist(), strict=False)
        steps = self.episode["steps"].item()
        return {term.name: value if term.event else steps * value for term, value in paid}


@pytest.fixture
def hand() -> Callable[..., Hand]:
    """Makes a task's state."""
    return Hand
