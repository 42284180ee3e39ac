"""Defines reward terms and observation columns that several tasks use."""

from __future__ import annotations

from slipgym.tasks.task import Column, term


@term(scale=0.1)
def effort(episode, world, fingers):
    """-(mean actuator force / gripper.force_max)."""
    return -(0.5 * (fingers[0].force + fingers[1].force) / episode.force_max)


@term(scale=0.1)
def smoothness(episode, world, fingers):
    """-(change of the commanded force / gripper.force_max)^2."""
    change = (episode.command - episode.last_command) / episode.force_max
    return -(change * change)


@term(scale=100.0)
def drop(episode, world, fingers):
    """-1 on a drop, else 0."""
    return -1.0 if episode.dropped else 0.0


TIME_LEFT = Column(
    "time_left", 0.0, 1000.0, "s", "time until the episode ends",
    read="(episode.steps - episode.step) * episode.step_time",
)  # fmt: skip
