"""One training run, from where it stands to its end."""

from __future__ import annotations

import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Any

from stable_baselines3.common.logger import Logger, TensorBoardOutputFormat
from torch.utils.tensorboard import SummaryWriter
from tqdm import tqdm

from policies.evaluation.plots.style import STYLE, styled
from policies.training import checkpoints, curve, export, folder, seeds, vector
from policies.training import model as learners
from policies.training.callback import TrainingCallback
from policies.training.config import Training
from policies.training.state_checks import fits

_COMMAND = "python scripts/train.py --resume {}"
"""What a policy's file says of its origin: the run's folder holds the rest."""


class _Logs(TensorBoardOutputFormat):
    """Logs for TensorBoard of a run that goes on at some step; what they have beyond is no longer shown."""

    def __init__(self, folder: Path, steps: int) -> None:
        self.writer, self._is_closed = SummaryWriter(str(folder), purge_step=steps), False


def train(path: Path, progress: bool = True, position: int = 0) -> dict[str, Any]:
    """Trains what a folder from `folder.begin` asks for, on from its last checkpoint; returns its result.

    A progress bar is shown on a line of the screen, counted from 0.

    Raises:
        FileNotFoundError: The folder holds no run.
        FloatingPointError: A parameter of the learner is NaN or huge.
        ValueError: Its checkpoints are damaged, or another process trains it.
        OSError: It cannot be written.
    """
    config, seed = folder.order(path)
    with folder.only_process(path):
        return folder.result(path) or _train(path, config, seed, progress, position)


def _train(path: Path, config: Training, seed: int, progress: bool, position: int) -> dict[str, Any]:
    state = checkpoints.last(path)
    model = learners.begin(config.without_start() if state else config, seeds.training(seed))
    held_out = vector.make(config, seeds.held_out(0), min(config.num_envs, config.evaluation.episodes))
    try:
        if state:
            with fits(f"{path}: the last checkpoint"):
                learners.set_state(model, state["learner"])
        steps = model.num_timesteps
        writer = _Logs(path / "tensorboard", steps)
        model.set_logger(Logger(None, [writer]))
        shown = {"desc": path.name, "position": position, "disable": not progress}
        with tqdm(total=config.budget, initial=steps, **shown) as bar:
            callback = TrainingCallback(config, path, held_out, bar)
            if state:
                with fits(f"{path}: the last checkpoint"):
                    callback.set_state(state["record"])
            if not callback.ended:
                _learn(model, config.budget - steps, callback, state is None)
        writer.close()
        return _finish(path, config, seed, model, callback)
    finally:
        model.get_env().close()
        held_out.close()


def _learn(model: Any, steps: int, callback: TrainingCallback, fresh: bool) -> None:
    try:
        model.learn(steps, callback, reset_num_timesteps=fresh)
    except (ValueError, RuntimeError):  # of torch, in the middle of an update
        learners.check_finite(model)
        raise


def _best(path: Path, callback: TrainingCallback) -> dict[str, Any]:
    """The best checkpoint of a run, or the last one if the best is damaged and another is whole."""
    try:
        return checkpoints.read(checkpoints.best(path))
    except (ValueError, FileNotFoundError) as error:
        last = checkpoints.last(path)
        if last is None:
            raise
        warnings.warn(f"{error}; the policy is that of the last checkpoint", stacklevel=2)
        return {"row": asdict(callback.curve[-1]), "learner": last["learner"]}


def _finish(
    path: Path, config: Training, seed: int, model: Any, callback: TrainingCallback
) -> dict[str, Any]:
    """Writes what a run leaves behind; the result last."""
    best = _best(path, callback)
    with fits(f"{checkpoints.best(path)}: the checkpoint"):
        learners.set_parameters(model, best["learner"])
    model.num_timesteps = best["row"]["steps"]
    export.write(model, best["learner"]["normalisation"], config, path, seed, _COMMAND.format(path.name))
    with styled():
        curve.plot({path.name: [callback.curve]}).savefig(path / "curve.png", dpi=STYLE.dpi)
    times = {"seconds": callback.seconds, "cpu_seconds": callback.cpu_seconds}
    result = {"ended": callback.ended, "steps": callback.curve[-1].steps, **times, "best": best["row"]}
    folder.write_result(path, result)
    return result
