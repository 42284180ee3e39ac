"""Fits the network of "gru" to sequences by their likelihood."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from tqdm import tqdm

from estimator.network.cell import HIDDEN, TARGETS
from estimator.network.weights import TENSORS
from lab.learned_estimator.columns import Sequence
from lab.learned_estimator.config import Training
from lab.learned_estimator.gradient import loss, loss_and_gradient

EVERY = 100
"""Updates between two rows of the curve."""
LIMIT = 1.0
"""Largest norm of a gradient."""
FIRST_WEIGHT = -3.0
"""Argument of the averages' weights at the start of training: a memory of 20 samples."""
WARM_UP = 0.05
"""Fraction of the updates in which the step size grows."""
FIXED = ("centre", "scale")
"""Tensors that are computed from the data once."""

Curve = list[dict[str, float]]


def fit(
    training: Training, data: list[Sequence], seed: int, progress: bool = True
) -> tuple[np.ndarray, Curve]:
    """Trains a network.

    Args:
        training: How.
        data: Sequences; some of them are held out.
        seed: Of the initial weights and the order of the data.
        progress: Whether to show a progress bar.

    Returns:
        The network as TENSORS (1,), and the curve: `update`, `training` and `held_out` losses.

    Raises:
        FloatingPointError: The loss is not finite.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(data)).tolist()
    kept = max(1, round(training.held_out * len(data)))
    held, used = [data[i] for i in order[:kept]], [data[i] for i in order[kept:]]
    network = first_weights(used, rng)
    adam, curve, recent = Adam(network), [], []
    batches = _batches(used, training.batch, rng)
    with tqdm(range(1, training.updates + 1), desc="training", disable=not progress) as updates:
        for update in updates:
            value, gradient = loss_and_gradient(network, next(batches))
            if not math.isfinite(value):
                raise FloatingPointError(f"the loss of update {update} is not finite")
            adam.step(gradient, training.learning_rate * _fraction(update / training.updates))
            recent.append(value)
            if update % EVERY == 0 or update == training.updates:
                row = {"update": update, "training": float(np.mean(recent)), "held_out": loss(network, held)}
                curve.append(row)
                recent.clear()
                updates.set_postfix_str(f"loss {row['training']:.3f}, held out {row['held_out']:.3f}")
    return network, curve


def first_weights(data: list[Sequence], rng: np.random.Generator) -> np.ndarray:
    """A network before training, TENSORS (1,): it states the mean of the data.

    Args:
        data: Sequences.
        rng: Random generator.
    """
    columns = np.concatenate([one.columns for one in data])
    network = np.zeros(1, TENSORS)
    for name in TENSORS.names or ():
        if name not in FIXED:
            network[name] = rng.uniform(-1.0, 1.0, network[name].shape) / math.sqrt(HIDDEN)
    for name in ("head_of_hidden", "head_of_columns"):
        network[name] *= 0.1
    network["start"] = np.concatenate([one.targets for one in data]).mean(axis=0)
    network["head_bias"] = 0.0
    network["head_bias"][0, :TARGETS] = FIRST_WEIGHT
    network["head_bias"][0, TARGETS : 2 * TARGETS] = network["start"][0]
    network["centre"] = columns.mean(axis=0, dtype=np.float64)
    network["scale"] = 1.0 / np.maximum(columns.std(axis=0, dtype=np.float64), 1e-3)
    return network


class Adam:
    """Stochastic gradient descent with moments (Kingma & Ba, ICLR 2015), gradients limited in norm.

    Args:
        network: TENSORS (1,), which `step` changes.
    """

    def __init__(self, network: np.ndarray) -> None:
        self._weights = network.view(np.float32)
        self._first, self._second = np.zeros((2, self._weights.size))
        self._count = 0

    def step(self, gradient: np.ndarray, size: float) -> None:
        """Makes a step.

        Args:
            gradient: TENSORS (1,); that of fixed tensors is zero.
            size: Of the step.
        """
        self._count += 1
        slope = gradient.view(np.float32).astype(np.float64)
        slope *= min(1.0, LIMIT / (float(np.linalg.norm(slope)) + 1e-12))
        self._first += 0.1 * (slope - self._first)
        self._second += 0.001 * (slope * slope - self._second)
        mean = self._first / (1.0 - 0.9**self._count)
        square = self._second / (1.0 - 0.999**self._count)
        self._weights -= (size * mean / (np.sqrt(square) + 1e-8)).astype(np.float32)


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
