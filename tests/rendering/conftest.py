from collections.abc import Callable, Iterator
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.registration import ENVIRONMENTS

SLIDE = "slipgym/LinearSlip-v0"


CARRYING = {f"slipgym/{name}-v0" for name in ("FragileHold", "Carry", "Explore", "PivotTo")}
"""Tasks that are drawn in the slow tests: they look like Hold or LinearSlip."""


@pytest.fixture(
    params=[pytest.param(each, marks=[pytest.mark.slow] * (each in CARRYING)) for each in ENVIRONMENTS]
)
def env_id(request) -> str:
    return request.param


@pytest.fixture
def make() -> Iterator[Callable[..., Any]]:
    """Makes bare environments, acted on by the grip force alone, and closes them after the test."""
    made = []

    def factory(
        env_id: str = "slipgym/LinearSlip-v0", render_mode: str = "rgb_array", **arguments: Any
    ) -> Any:
        env = gym.make(
            env_id, render_mode=render_mode, **{"action_mode": "grip_force", **arguments}
        ).unwrapped
        made.append(env)
        return env

    yield factory
    for env in made:
        env.close()


@pytest.fixture
def changed() -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Which pixels differ by more than noise of rounding, (height, width)."""
    return lambda before, after: np.abs(before.astype(int) - after).max(axis=-1) > 8


@pytest.fixture
def hidden_screen(monkeypatch) -> None:
    """Windows open where nobody sees them."""
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("PYGAME_HIDE_SUPPORT_PROMPT", "1")
