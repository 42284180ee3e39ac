"""Draws the pictures of the environments' pages: one of each, and an animation of all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from PIL import Image

import policies
from policies.play.video import Gif
from policies.stepping import steps
from policies.task_names import own_policy
from slipgym.atomic_io import new_file
from slipgym.registration import ENVIRONMENTS
from slipgym.rendering import camera
from slipgym.tasks import find

MATERIALS = "wood", "plastic", "case", "cardboard"
RATE = 10
"""Frames per second."""
COLUMNS = 3
"""Episodes in a row."""
FRACTION = 0.62
"""Of an episode, after which a picture of it is taken."""
REST = 0.8
"""Time that each episode's last picture stays, at least [s]."""


def write_montage(
    path: Path, seconds: float = 6.0, seed: int = 3, ids: Sequence[str] = tuple(ENVIRONMENTS)
) -> None:
    """Writes an animated GIF: the first seconds of an episode of each task, with its own controller.

    Args:
        path: The file.
        seconds: Length of the animation; an episode that is longer runs faster, so that its end is seen [s].
        seed: Of the environments.
        ids: Ids of environments.
    """
    films = [film(name, MATERIALS[k % len(MATERIALS)], seconds, seed) for k, name in enumerate(ids)]
    with new_file(path) as partial:
        gif = Gif(partial, RATE)
        for views in zip(*films, strict=True):
            gif.add(tiled(views))
        gif.finish()


def film(env_id: str, material: str, seconds: float, seed: int) -> list[np.ndarray]:
    """Views of an episode on the planar engine, evenly spaced in its time, at half the size of a picture."""
    policy = policies.make(own_policy(env_id))
    made = {"engine": "planar", "render_mode": "rgb_array", "material": material, **policies.modes(policy)}
    env: Any = gym.make(env_id, disable_env_checker=True, **made).unwrapped
    moving = round((seconds - REST) * RATE)
    try:
        observation, _ = env.reset(seed=seed)
        total = int(env.simulation.episode[0]["steps"])
        wanted = set(np.linspace(1, total, moving).round().astype(int).tolist())
        views = [
            halved(env.render()[:, : camera.WIDTH])
            for k, _ in enumerate(steps(env, policy, observation), 1)
            if k in wanted
        ]
    finally:
        env.close()
    return views + [views[-1]] * (round(seconds * RATE) - len(views))


def halved(picture: np.ndarray) -> np.ndarray:
    """A picture (2 h, 2 w, 3) with half the size."""
    height, width = picture.shape[0] // 2, picture.shape[1] // 2
    blocks = picture.reshape(height, 2, width, 2, 3).astype(np.uint16).sum(axis=(1, 3))
    return ((blocks + 2) // 4).astype(np.uint8)


def tiled(views: Sequence[np.ndarray]) -> np.ndarray:
    """Views side by side, `COLUMNS` in a row, on white."""
    height, width, _ = views[0].shape
    columns = min(COLUMNS, len(views))
    rows = -(-len(views) // columns)
    whole = np.full((rows * height, columns * width, 3), 255, np.uint8)
    for k, view in enumerate(views):
        row, column = divmod(k, columns)
        whole[row * height : (row + 1) * height, column * width : (column + 1) * width] = view
    return whole


def take_screenshot(env_id: str, material: str, seed: int = 0) -> np.ndarray:
    """A picture from the middle of an episode.

    Args:
        env_id: Id of an environment.
        material: Name of a material.
        seed: Of the environment.

    Returns:
        (480, 720, 3) uint8.
    """
    policy = policies.make(own_policy(env_id))
    modes = policies.modes(policy)
    env: Any = gym.make(env_id, render_mode="rgb_array", material=material, **modes).unwrapped
    try:
        observation, _ = env.reset(seed=seed)
        episode = env.simulation.episode[0]
        for _ in steps(env, policy, observation):
            if episode["step"] >= FRACTION * episode["steps"]:
                break
        return env.render()
    finally:
        env.close()


def write_screenshots(folder: Path, seed: int = 0) -> Iterator[Path]:
    """Writes <task's key>.png for every registered environment, each with another material.

    Args:
        folder: Where to.
        seed: Of the environments.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for number, env_id in enumerate(ENVIRONMENTS):
        picture = take_screenshot(env_id, MATERIALS[number % len(MATERIALS)], seed)
        path = folder / f"{find(env_id).key}.png"
        with new_file(path) as partial:
            Image.fromarray(picture).save(partial, format="PNG", optimize=True)
        yield path
