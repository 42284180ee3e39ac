"""Steps an environment with a policy until the episode ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from policies.registry import Policy


class Step(NamedTuple):
    """What `env.step` returned."""

    observation: Any
    """The observation after the step: an array, or a mapping of groups."""
    reward: float
    """Reward of the step."""
    terminated: bool
    """Whether the task ended the episode."""
    truncated: bool
    """Whether its time was over."""
    info: Mapping[str, Any]
    """See `slipgym.envs.infos`."""

    @property
    def over(self) -> bool:
        """Whether the episode ended."""
        return self.terminated or self.truncated


def steps(env: Any, policy: Policy, observation: Any) -> Iterator[Step]:
    """Acts with a policy, without exploration, until the episode ends.

    Each step is yielded before the policy acts on it; who stops asking stops the episode.

    Args:
        env: A Gymnasium environment that was just reset.
        policy: Who acts; its memory starts fresh.
        observation: What `reset` returned.
    """
    state, over = None, False
    while not over:
        action, state = policy.predict(observation, state=state)
        step = Step(*env.step(action))
        observation, over = step.observation, step.over
        yield step
