"""Fits the network of "gru" to sequences by their likelihood, with torch."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
import torch
from torch import nn
from tqdm import tqdm

from lab.learned_estimator.cell import HIDDEN, TARGETS
from lab.learned_estimator.columns import Sequence
from lab.learned_estimator.config import Training
from lab.learned_estimator.network import FIXED, Network
from lab.learned_estimator.weights import SHAPES, Tensors

EVERY = 100
"""Updates between two rows of the curve."""
LIMIT = 1.0
"""Largest norm of a gradient."""
FIRST_WEIGHT = -3.0
"""Argument of the averages' weights at the start of training: a memory of 20 samples."""
WARM_UP = 0.05
"""Fraction of the updates in which the step size grows."""

Curve = list[dict[str, float]]


def fit(
    training: Training,
    data: list[Sequence],
    seed: int,
    keep: Callable[[Tensors, Curve], None],
    progress: bool = True,
) -> None:
    """Trains a network in one thread, which makes the same network of the same seed.

    Args:
        training: How.
        data: Sequences; some of them are held out.
        seed: Of the initial weights and the order of the data.
        keep: Gets the network's tensors and the curve so far (`update`, `training` and `held_out` losses)
            every `EVERY` updates and after the last.
        progress: Whether to show a progress bar.

    Raises:
        FloatingPointError: The loss is not finite.
    """
    torch.set_num_threads(1)
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(data)).tolist()
    kept = max(1, round(training.held_out * len(data)))
    held, used = [data[i] for i in order[:kept]], [data[i] for i in order[kept:]]
    network = Network(first_weights(used, rng))
    optimiser = torch.optim.Adam(network.parameters(), training.learning_rate)
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda k: _fraction((k + 1) / training.updates))
    curve: Curve = []
    recent: list[float] = []
    batches = _batches(used, training.batch, rng)
    with tqdm(range(1, training.updates + 1), desc="training", disable=not progress) as updates:
        for update in updates:
            loss = network.loss(next(batches))
            if not torch.isfinite(loss):
                raise FloatingPointError(f"the loss of update {update} is not finite")
            optimiser.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(network.parameters(), LIMIT)
            optimiser.step()
            schedule.step()
            recent.append(loss.item())
            if update % EVERY == 0 or update == training.updates:
                with torch.no_grad():
                    held_out = network.loss(held).item()
                curve.append({"update": update, "training": float(np.mean(recent)), "held_out": held_out})
                recent.clear()
                keep(network.tensors(), curve)
                updates.set_postfix_str(f"loss {curve[-1]['training']:.3f}, held out {held_out:.3f}")


def first_weights(data: list[Sequence], rng: np.random.Generator) -> Tensors:
    """Tensors of a network before training: it states the mean of the data.

    Args:
        data: Sequences.
        rng: Random generator.
    """
    columns = np.concatenate([one.columns for one in data])
    network = {name: np.zeros(shape, np.float32) for name, shape in SHAPES.items()}
    for name in (name for name in SHAPES if name not in {*FIXED, "head_bias", "start"}):
        network[name][:] = rng.uniform(-1.0, 1.0, SHAPES[name]) / math.sqrt(HIDDEN)
    for name in ("head_of_hidden", "head_of_columns"):
        network[name] *= np.float32(0.1)
    network["start"][:] = np.concatenate([one.targets for one in data]).mean(axis=0)
    network["head_bias"][:TARGETS] = FIRST_WEIGHT
    network["head_bias"][TARGETS : 2 * TARGETS] = network["start"]
    network["centre"][:] = columns.mean(axis=0, dtype=np.float64)
    network["scale"][:] = 1.0 / np.maximum(columns.std(axis=0, dtype=np.float64), 1e-3)
    return network


def _fraction(progress: float) -> float:
    """Step size over the largest: it grows in `WARM_UP`, then falls as a cosine."""
    if progress < WARM_UP:
        return progress / WARM_UP
    return 0.5 * (1.0 + math.cos(math.pi * (progress - WARM_UP) / (1.0 - WARM_UP)))


def _batches(data: list[Sequence], size: int, rng: np.random.Generator) -> Iterator[list[Sequence]]:
    while True:
        order = rng.permutation(len(data)).tolist()
        for i in range(0, len(order), size):
            yield [data[k] for k in order[i : i + size]]
