"""Fits the network to sequences by their likelihood."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import torch
from tqdm import tqdm

from policies.research.learned_estimator.columns import Sequence
from policies.research.learned_estimator.config import Training
from policies.research.learned_estimator.network import Network, loss

EVERY = 100
"""Updates between two rows of the curve."""
BUNDLE = 16
"""Batches that are drawn together and formed by length, so that little is padded."""
LIMIT = 1.0
"""Largest norm of a gradient."""

Batch = tuple[torch.Tensor, torch.Tensor, torch.Tensor]


def fit(
    training: Training, data: list[Sequence], seed: int, progress: bool = True
) -> tuple[Network, list[dict[str, float]]]:
    """Trains a network.

    Args:
        training: How.
        data: Sequences; some of them are held out.
        seed: Of the initial weights and the order of the data.
        progress: Whether to show a progress bar.

    Returns:
        The network, and the curve: `update`, `training` and `held_out` losses.

    Raises:
        FloatingPointError: The loss is not finite.
    """
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(data))
    kept = max(1, round(training.held_out * len(data)))
    held, used = [data[i] for i in order[:kept]], [data[i] for i in order[kept:]]
    network = _fresh(used)
    optimiser = torch.optim.Adam(network.parameters(), lr=training.learning_rate)
    schedule: Any = torch.optim.lr_scheduler.OneCycleLR(
        optimiser, training.learning_rate, training.updates, pct_start=0.05
    )
    checks = [_padded(held[i : i + training.batch]) for i in range(0, len(held), training.batch)]
    curve, recent = [], []
    batches = _batches(used, training.batch, rng)
    with tqdm(range(1, training.updates + 1), desc="training", disable=not progress) as updates:
        for update in updates:
            columns, targets, mask = next(batches)
            value = loss(*network(columns), targets, mask)
            if not torch.isfinite(value):
                raise FloatingPointError(f"the loss of update {update} is not finite")
            optimiser.zero_grad()
            value.backward()
            torch.nn.utils.clip_grad_norm_(network.parameters(), LIMIT)
            optimiser.step()
            schedule.step()
            recent.append(float(value.detach()))
            if update % EVERY == 0 or update == training.updates:
                row = {"update": update, "training": float(np.mean(recent)), "held_out": _held(network, checks)}
                curve.append(row)
                recent.clear()
                updates.set_postfix_str(f"loss {row['training']:.3f}, held out {row['held_out']:.3f}")
    return network, curve


def _fresh(data: list[Sequence]) -> Network:
    columns = np.concatenate([one.columns for one in data])
    targets = np.concatenate([one.targets for one in data])
    spread = np.maximum(columns.std(axis=0, dtype=np.float64), 1e-3)
    return Network(columns.mean(axis=0, dtype=np.float64), 1.0 / spread, targets.mean(axis=0))


def _held(network: Network, checks: list[Batch]) -> float:
    with torch.no_grad():
        values = [float(loss(*network(x), y, mask)) * float(mask.sum()) for x, y, mask in checks]
    return sum(values) / sum(float(mask.sum()) for *_, mask in checks)


def _batches(data: list[Sequence], size: int, rng: np.random.Generator) -> Iterator[Batch]:
    lengths = np.array([len(one.columns) for one in data])
    while True:
        order = rng.permutation(len(data))
        for i in range(0, len(order), BUNDLE * size):
            bundle = order[i : i + BUNDLE * size]
            bundle = bundle[np.argsort(lengths[bundle], kind="stable")]
            starts = rng.permutation(range(0, len(bundle), size))
            for j in starts.tolist():
                yield _padded([data[k] for k in bundle[j : j + size].tolist()])


def _padded(chosen: list[Sequence]) -> Batch:
    """Columns (t, n, COLUMNS), targets (t, n, 3) and which samples exist (t, n)."""
    n, longest = len(chosen), max(len(one.columns) for one in chosen)
    columns = np.zeros((longest, n, chosen[0].columns.shape[1]), np.float32)
    targets, mask = np.zeros((longest, n, 3), np.float32), np.zeros((longest, n), bool)
    for i, one in enumerate(chosen):
        m = len(one.columns)
        columns[:m, i], targets[:m, i], mask[:m, i] = one.columns, one.targets, True
    return torch.from_numpy(columns), torch.from_numpy(targets), torch.from_numpy(mask)
