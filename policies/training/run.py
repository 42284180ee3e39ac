"""One training run, from where it stands to its end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stable_baselines3.common.logger import Logger
from tqdm import tqdm

from policies.evaluation.plots.style import STYLE, styled
from policies.training import checkpoint_io, checkpoints, curve, export, folder, seeds, vector
from policies.training import model as learners
from policies.training.callback import TrainingCallback
from policies.training.config import Training
from policies.training.tensorboard_writer import TensorboardWriter

_COMMAND = "python scripts/train.py --resume {}"
"""What a policy's file says of its origin: the run's folder holds the rest."""


def train(path: Path, progress: bool = True, position: int = 0) -> dict[str, Any]:
    """Trains what a folder asks for, on from its last checkpoint.

    Args:
        path: The run's folder, from `folder.begin`.
        progress: Whether to show a progress bar.
        position: Its line on the screen, counted from 0.

    Returns:
        How it ended, as in result.json.

    Raises:
        FileNotFoundError: The folder holds no run.
        ValueError: Its checkpoints are damaged.
        OSError: It cannot be written.
    """
    config, seed = folder.order(path)
    done = folder.result(path)
    if done is not None:
        return done
    first = seeds.training(seed)
    episodes = min(config.num_envs, config.evaluation.episodes)
    training = vector.make(config, first, shaped=True)
    held_out = vector.make(config, seeds.held_out(0), episodes)
    try:
        model = learners.make(config, learners.normalised(config, training), first)
        state = checkpoints.last(path)
        steps = state["learner"]["counters"]["num_timesteps"] if state else 0
        writer = TensorboardWriter(path / "tensorboard", steps)
        model.set_logger(Logger(None, [writer]))
        with tqdm(
            total=config.budget, initial=steps, desc=path.name, position=position, disable=not progress
        ) as bar:
            callback = TrainingCallback(config, path, held_out, bar)
            if state:
                learners.set_state(model, state["learner"])
                callback.set_state(state["record"])
            if not callback.ended:
                model.learn(config.budget - steps, callback, reset_num_timesteps=state is None)
        writer.close()
        return _finish(path, config, seed, model, callback)
    finally:
        training.close()
        held_out.close()


def _finish(
    path: Path, config: Training, seed: int, model: Any, callback: TrainingCallback
) -> dict[str, Any]:
    """Writes what a run leaves behind; the result last."""
    best = checkpoint_io.read(checkpoints.best(path))
    learners.set_parameters(model, best["learner"])
    export.write(model, best["learner"]["normalisation"], config, path, seed, _COMMAND.format(path.name))
    with styled():
        curve.plot({path.name: [callback.curve]}).savefig(path / "curve.png", dpi=STYLE.dpi)
    result = {
        "ended": callback.ended,
        "steps": callback.curve[-1].steps,
        "seconds": callback.seconds,
        "cpu_seconds": callback.cpu_seconds,
        "best": best["row"],
    }
    folder.write_result(path, result)
    return result
