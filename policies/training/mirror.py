"""Samples that are learned from twice: as they happened, and with left and right exchanged.

Where physics and task are symmetric to the vertical plane through the finger axis, the mirror image of an
episode is an episode, too. Mirroring changes the sign of some columns of observation and action and leaves
the others (Mittal et al., "Symmetry considerations for learning task symmetric robot policies", ICRA 2024).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from tensordict import TensorDict

from policies.training.derived import Derived
from slipgym.config.errors import unknown

_FINGERS = "_1", "_2"


class Mirror:
    """Mirrors what a learner observes and does.

    Attributes:
        groups: Group of observations -> sign of each column, (m,).
        action: Sign of each component of the action, (k,).
    """

    def __init__(self, mirrored: Sequence[str], envs: Any, derived: Derived, history: int) -> None:
        """Of the columns' names without finger that change sign.

        Raises:
            ValueError: There is no such column, or a derived one combines columns of both kinds.
        """
        parts = {"policy": "columns", "privileged": "privileged_columns", "action": "action_columns"}
        names = {part: [each.name for each in envs.get_attr(of)[0]] for part, of in parts.items()}
        known = {_bare(name) for part in names.values() for name in part}
        for name in (name for name in mirrored if name not in known):
            raise ValueError(f"privileged_ppo.mirrored: {unknown('column', name, sorted(known))}")
        found = {part: [_sign(name, mirrored) for name in of] for part, of in names.items()}
        more = [_of_derived(name, combined, mirrored) for name, combined in derived.items()]
        self.action = torch.tensor(found["action"])
        policy = found["policy"] * (history + 1) + more * (history + 1)
        self.groups = {"policy": torch.tensor(policy), "privileged": torch.tensor(found["privileged"])}

    def __call__(
        self, env: Any, obs: Any = None, actions: torch.Tensor | None = None
    ) -> tuple[TensorDict | None, torch.Tensor | None]:
        """Observations and actions, (n, m) and (n, k), with their mirror images behind them, for rsl-rl."""
        both = None
        if obs is not None:
            pairs = {name: torch.cat((values, values * self.groups[name])) for name, values in obs.items()}
            both = TensorDict(pairs, batch_size=[2 * len(obs)])
        return both, None if actions is None else torch.cat((actions, actions * self.action))


def _bare(name: str) -> str:
    return name[:-2] if name.endswith(_FINGERS) else name


def _sign(name: str, mirrored: Sequence[str]) -> float:
    return -1.0 if _bare(name) in mirrored else 1.0


def _of_derived(name: str, combined: Mapping[str, float], mirrored: Sequence[str]) -> float:
    signs = {_sign(column, mirrored) for column in combined}
    if len(signs) > 1:
        raise ValueError(
            f"privileged_ppo.mirrored: derived column {name!r} combines mirrored and other columns"
        )
    return min(signs, default=1.0)
