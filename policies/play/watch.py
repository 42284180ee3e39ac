"""Plays episodes in a window or into a video."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

import policies
from estimator.reference import is_reference
from policies.play.video import Video
from policies.registry import Policy
from policies.stepping import make_for, own_arguments, steps
from policies.task_names import own_policy
from slipgym.atomic_io import check_file
from slipgym.config import Config
from slipgym.config.errors import unknown
from slipgym.envs.slip_env import SlipEnv
from slipgym.rendering import HEIGHT, WIDTH, WINDOW_RATE, Window
from slipgym.tasks import find

KEYBOARD = "keyboard"
"""Name of the policy that is whoever sits at the keyboard."""
_FORCE_RATE = 8.0  # of a key held down [N/s]


@dataclass(frozen=True)
class Outcome:
    """Outcome of an episode."""

    seed: int
    """Of the environment."""
    time: float
    """When it ended [s]."""
    success: bool
    dropped: bool
    slip: tuple[float, float, float]
    """Slip displacement at the end (x, y, theta) [m, m, rad]."""
    reward: float
    """Sum over the episode."""

    @classmethod
    def of(cls, seed: int, info: Mapping[str, Any], reward: float) -> Outcome:
        """Outcome of an episode by its last info."""
        slip = tuple(info["slip"].tolist())
        return cls(seed, info["time"], info["is_success"], info["dropped"], slip, reward)

    @property
    def ending(self) -> str:
        """In words: dropped, success or no success."""
        return "dropped" if self.dropped else "success" if self.success else "no success"

    def words(self) -> str:
        """One line about it."""
        slid, turned = 1e3 * math.hypot(*self.slip[:2]), math.degrees(self.slip[2])
        return (
            f"seed {self.seed}: {self.ending} after {self.time:.2f} s; "
            f"slid {slid:.1f} mm, turned {round(turned, 1) + 0.0:.1f}°; reward {self.reward:.1f}"
        )


class Keyboard:
    """A policy by hand: from a force per finger [N], up grips harder and down more loosely."""

    action_mode = "grip_force"

    def __init__(self, window: Window, config: Config, force: float) -> None:
        self._window, self._gripper, self._start = window, config.gripper, force
        self._change = _FORCE_RATE / config.physics.control_rate

    def predict(
        self,
        observation: np.ndarray,
        state: float | None = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, float]:
        """Action for whatever is seen, and the force as the memory."""
        low, high = self._gripper.force_min, self._gripper.force_max
        force = self._start if state is None else state
        force = min(max(force + self._change * self._window.vertical(), low), high)
        return np.array([2.0 * (force - low) / (high - low) - 1.0], dtype=np.float32), force


def watch(
    task: str,
    policy: str | os.PathLike[str] | Policy | None = None,
    video: str | os.PathLike[str] | None = None,
    episodes: int = 1,
    seed: int = 0,
    speed: float = 1.0,
    options: Mapping[str, Any] | None = None,
    progress: bool = True,
    **keywords: Any,
) -> list[Outcome]:
    """Plays a policy in a window, or into a video.

    Args:
        task: "LinearSlip" or whatever else `slipgym.tasks.find` takes.
        policy: A name of `policies.names()`, the path of a trained policy, a policy, or `KEYBOARD` in a
            window; None for the task's own.
        video: MP4 or GIF to write; None opens a window.
        episodes: How many, one after the other.
        seed: Of the first; the others' follow.
        speed: Seconds of simulation per second of watching.
        options: Of every reset.
        progress: Whether making a video shows a progress bar.
        **keywords: Of the environment.

    Returns:
        How each episode went; fewer than asked for if someone closed the window.

    Raises:
        ValueError: A value is unknown or not allowed.
        FileNotFoundError: There is no policy at the path.
        OSError: The video cannot be written.
        RuntimeError: A window was asked for and cannot open.
    """
    env_id = find(task).id
    if not 0.01 <= speed <= 100.0:
        raise ValueError(f"speed = {speed!r} must lie in 0.01 to 100")
    if episodes < 1:
        raise ValueError(f"episodes = {episodes!r} must be at least 1")
    if policy == KEYBOARD and video is not None:
        raise ValueError(
            f"policy {KEYBOARD!r} needs a window; valid for a video: {', '.join(policies.names())}"
        )
    if video is not None:
        Video(video)  # whether its type is known
        check_file(Path(video))
    outcomes = []
    with ExitStack() as stack:
        name = policy or own_policy(task)
        player: Any = Keyboard if policy == KEYBOARD else _policy(name)
        env: Any = environment(env_id, name, player, keywords)
        stack.callback(env.close)
        if video is None:
            window = Window(f"slipgym {task}", keywords.get("render_size") or (WIDTH, HEIGHT))
            stack.callback(window.close)
            if player is Keyboard:
                player = Keyboard(window, env.config, env.settings.initial_force)
            rate: float = WINDOW_RATE

            def show(picture: np.ndarray) -> bool:
                window.show(picture, WINDOW_RATE)
                return not window.closed
        else:
            recording = stack.enter_context(Video(video))
            rate = recording.rate

            def show(picture: np.ndarray) -> bool:
                recording.add(picture)
                return True

        for number in range(episodes):
            bar = progress and video is not None
            outcome = _episode(env, player, show, speed / rate, seed + number, options, bar)
            if outcome is None:
                break
            outcomes.append(outcome)
    return outcomes


def environment(env_id: str, name: object, policy: Any, keywords: Mapping[str, Any]) -> Any:
    """Makes the environment that a policy of some name, or a class of policies, acts in.

    That of a learned policy is the one of its training, with the keywords in place of its arguments.

    Raises:
        ValueError: A keyword is not allowed, or the policy does not fit.
    """
    keywords = own_arguments(policy, env_id, keywords)
    policies.check_estimates(name, policy, keywords)
    return make_for(policy, env_id, render_mode="rgb_array", **keywords).unwrapped


def _episode(
    env: SlipEnv,
    policy: Any,
    show: Callable[[np.ndarray], bool],
    interval: float,
    seed: int,
    options: Mapping[str, Any] | None,
    progress: bool,
) -> Outcome | None:
    """One episode, a picture each interval [s] and at the end; None if it was broken off."""
    observation, info = env.reset(seed=seed, options=dict(options or {}))
    shown, reward, episode = 0, 0.0, env.simulation.episode[0]

    def show_due(time: float) -> bool:
        nonlocal shown
        while time >= shown * interval - 1e-9:
            shown += 1
            if not show(env.render()):  # type: ignore[arg-type]
                return False
        return True

    if not show_due(info["time"]):
        return None
    title = f"{env.task.name}, seed {seed}"
    with tqdm(total=int(episode["steps"]), desc=title, unit="control step", disable=not progress) as bar:
        for step in steps(env, policy, observation):
            reward, info = reward + float(step.reward), step.info
            bar.update(int(episode["step"]) - bar.n)
            if not step.over and not show_due(info["time"]):
                return None
    show(env.render())  # type: ignore[arg-type]
    return Outcome.of(seed, info, reward)


def _policy(name: str | os.PathLike[str] | Policy) -> Policy:
    """A policy by its name, or from where it was saved; or as it is."""
    if isinstance(name, os.PathLike):
        return policies.load(name)
    if not isinstance(name, str):
        return name
    if name in policies.names() or is_reference(name) or Path(name).exists() or os.sep in name:
        return policies.load(name)
    raise ValueError(
        f"{unknown('policy', name, [KEYBOARD, *policies.names()])}; or the path of a trained one"
    )
