"""Defines reward terms and observation columns that several tasks use."""

from __future__ import annotations

from slipgym.tasks.episode import slip_distance
from slipgym.tasks.task import Column, event, term


@term(scale=0.1)
def effort(episode, world, fingers):
    """-(mean actuator force / gripper.force_max)."""
    return -(0.5 * (fingers[0].force + fingers[1].force) / episode.force_max)


@term(scale=0.1)
def smoothness(episode, world, fingers):
    """-(change of the commanded force / gripper.force_max)^2."""
    change = (episode.command - episode.last_command) / episode.force_max
    return -(change * change)


@term(scale=0.5)
def sliding(episode, world, fingers):
    """-(slip at the pad centre) / (10 slide_tolerance)."""
    return -slip_distance(world) / (10.0 * episode.slide_tolerance)


@event(scale=10.0)
def solved(episode, world, fingers):
    """1 at the end of an episode that is a success."""
    return 1.0 if episode.success else 0.0


@event(scale=2.0)
def violated(episode, world, fingers):
    """-1 when success becomes impossible, see Episode End."""
    return -1.0 if episode.just_violated else 0.0


@event(scale=1.0)
def drop(episode, world, fingers):
    """-1 on a drop."""
    return -1.0 if episode.dropped else 0.0


OUTCOME = solved, violated, drop
"""Events of a task in which success can become impossible before the end."""
TIME_LEFT = Column(
    "time_left", 0.0, 1000.0, "s", "time until the episode ends",
    read="(episode.steps - episode.step) * episode.step_time",
)  # fmt: skip

VIOLATED = Column(
    "violated", 0.0, 1.0, "-", "1 once success has become impossible, else 0",
    read="1.0 if episode.violated else 0.0",
)  # fmt: skip
