"""Loss of the network of "gru" and its gradient, by the estimator's own compiled step.

The loss of a sample is the mean, over mu_s, mu_c, r and mu_c r, of the negative log-likelihood of the
logarithm's error under a normal distribution with the stated deviation, less a constant. The gradient follows
the samples of a sequence backwards (backpropagation through time, Werbos, Proc. IEEE 78, 1990). The products
with the weights' gradients are formed for all samples at once.
"""

from __future__ import annotations

from collections.abc import Sequence as Several

import numpy as np

from estimator._numba.caching import njit
from estimator.network.cell import (
    HIDDEN,
    HIGH,
    LEVER,
    LOW,
    MU_C,
    ONE,
    OUTPUTS,
    TARGETS,
    R,
    accumulate,
    advance,
)
from estimator.network.weights import TENSORS
from lab.learned_estimator.columns import Sequence

DEVIATIONS = 2 * TARGETS
"""Index of the first deviation among the outputs."""


@njit(error_model="numpy")
def _forward(p, columns, ends, gates, by_h, hidden, out, means):
    """Runs sequences that follow one another; stores what every step wrote.

    Args:
        p: TENSORS record.
        columns: (n, COLUMNS), normalised in place.
        ends: Sample after the last of each sequence, (m,).
        gates: Output (n, 3 HIDDEN), as the next ones see `estimator.network.cell.advance`.
        by_h: Output (n, 3 HIDDEN).
        hidden: Output (n, HIDDEN), after the step.
        out: Output (n, OUTPUTS).
        means: Output (n, TARGETS).
    """
    state, mean = np.zeros(HIDDEN, np.float32), np.zeros(TARGETS, np.float32)
    first = 0
    for end in ends:
        state[:] = np.float32(0.0)
        mean[:] = p.start
        for k in range(first, end):
            advance(p, (columns[k], gates[k], by_h[k], out[k]), state, mean)
            hidden[k] = state
            means[k] = mean
        first = end


@njit(error_model="numpy")
def _likelihood(error, deviation):
    """Loss of a target, its derivative by the error, and that by the argument of the deviation."""
    precision = np.exp(-2.0 * deviation)
    square = error * error * precision
    share = (deviation - LOW) / (HIGH - LOW)
    return 0.5 * square + deviation, error * precision, (1.0 - square) * (HIGH - LOW) * share * (1.0 - share)


@njit(error_model="numpy")
def _of_sample(targets, mean, out, by_mean, by_out):
    """Loss of a sample, times 4; writes its derivatives by means and arguments of deviations."""
    total = 0.0
    for j in range(TARGETS):
        each, slope, by_out[DEVIATIONS + j] = _likelihood(targets[j] - mean[j], out[DEVIATIONS + j])
        total += each
        by_mean[j] = -slope
    error = targets[MU_C] - mean[MU_C] + targets[R] - mean[R]
    each, slope, by_out[DEVIATIONS + LEVER] = _likelihood(error, out[DEVIATIONS + LEVER])
    by_mean[MU_C] -= slope
    by_mean[R] -= slope
    return total + each


@njit(error_model="numpy")
def _through_gates(old, written, k, by_state, by_gates, by_parts):
    """Derivatives by the gates' arguments and their parts of a sample, from those by its hidden state."""
    gates, by_h = written[0][k], written[1][k]
    for i in range(HIDDEN):
        reset, update, new = gates[i], gates[HIDDEN + i], gates[2 * HIDDEN + i]
        by_new = by_state[i] * (ONE - update) * (ONE - new * new)
        by_parts[2 * HIDDEN + i], by_gates[2 * HIDDEN + i] = by_new * reset, by_new
        by_reset = by_new * by_h[2 * HIDDEN + i] * reset * (ONE - reset)
        by_update = by_state[i] * (old[i] - new) * update * (ONE - update)
        by_gates[i], by_parts[i] = by_reset, by_reset
        by_gates[HIDDEN + i], by_parts[HIDDEN + i] = by_update, by_update
        by_state[i] *= update


@njit(error_model="numpy")
def _backward(p, transposed, targets, ends, written, found, start):
    """Derivatives of the sum of all losses, times 4.

    Args:
        p: TENSORS record.
        transposed: Hidden weights (3 HIDDEN, HIDDEN), and weights of the head (OUTPUTS, HIDDEN).
        targets: (n, TARGETS).
        ends: As in `_forward`.
        written: What `_forward` wrote: gates, by_h, hidden, out, means.
        found: Output: by the gates' arguments and by what the hidden state adds to them, (n, 3 HIDDEN); by
            the outputs' arguments, (n, OUTPUTS).
        start: Output (TARGETS,), by the averages before the first sample.

    Returns:
        The sum of all losses, times 4.
    """
    _, _, hidden, out, means = written
    by_gates, by_parts, by_out = found
    total, nothing = 0.0, np.zeros(HIDDEN, np.float32)
    by_state, by_mean, by_average = np.zeros(HIDDEN, np.float32), np.zeros(TARGETS), np.zeros(TARGETS)
    for m in range(len(ends)):
        first = ends[m - 1] if m > 0 else 0
        by_state[:] = np.float32(0.0)
        by_average[:] = 0.0
        for k in range(ends[m] - 1, first - 1, -1):
            total += _of_sample(targets[k], means[k], out[k], by_mean, by_out[k])
            for j in range(TARGETS):
                before = means[k - 1, j] if k > first else p.start[j]
                weight = out[k, j]
                along = by_average[j] + by_mean[j]
                by_out[k, j] = along * (out[k, TARGETS + j] - before) * weight * (ONE - weight)
                by_out[k, TARGETS + j] = along * weight
                by_average[j] = along * (ONE - weight)
            accumulate(by_state, by_out[k], transposed[1], OUTPUTS)
            old = hidden[k - 1] if k > first else nothing
            _through_gates(old, written, k, by_state, by_gates[k], by_parts[k])
            accumulate(by_state, by_parts[k], transposed[0], 3 * HIDDEN)
        for j in range(TARGETS):
            start[j] += by_average[j]
    return total


def loss(p: np.ndarray, sequences: Several[Sequence]) -> float:
    """Mean loss of the samples of sequences.

    Args:
        p: TENSORS (1,).
        sequences: Sequences.
    """
    return _evaluated(p, sequences, None)


def loss_and_gradient(p: np.ndarray, sequences: Several[Sequence]) -> tuple[float, np.ndarray]:
    """Mean loss of the samples of sequences, and its derivatives by all tensors but centre and scale.

    Args:
        p: TENSORS (1,).
        sequences: Sequences.

    Returns:
        The loss, and the derivatives as TENSORS (1,).
    """
    gradient = np.zeros(1, TENSORS)
    return _evaluated(p, sequences, gradient), gradient


def _evaluated(p: np.ndarray, sequences: Several[Sequence], gradient: np.ndarray | None) -> float:
    columns = np.concatenate([one.columns for one in sequences])
    targets = np.concatenate([one.targets for one in sequences]).astype(np.float32)
    ends = np.cumsum([len(one.columns) for one in sequences])
    n = len(columns)
    widths = (3 * HIDDEN, 3 * HIDDEN, HIDDEN, OUTPUTS, TARGETS)
    gates, by_h, hidden, out, means = (np.empty((n, width), np.float32) for width in widths)
    written = gates, by_h, hidden, out, means
    _forward(p[0], columns, ends, *written)
    by_gates, by_parts = np.empty((2, n, 3 * HIDDEN), np.float32)
    by_out, start = np.empty((n, OUTPUTS), np.float32), np.zeros(TARGETS)
    across, heads = (np.ascontiguousarray(p[name][0].T) for name in ("hidden_weight", "head_of_hidden"))
    found = by_gates, by_parts, by_out
    total = _backward(p[0], (across, heads), targets, ends, written, found, start)
    scale = 1.0 / ((LEVER + 1) * n)
    if gradient is not None:
        old = np.concatenate([np.zeros((1, HIDDEN), np.float32), hidden[:-1]])
        old[ends[:-1]] = 0.0
        slopes = {
            "input_weight": columns.T @ by_gates,
            "input_bias": by_gates.sum(axis=0),
            "hidden_weight": old.T @ by_parts,
            "hidden_bias": by_parts.sum(axis=0),
            "head_of_hidden": hidden.T @ by_out,
            "head_of_columns": columns.T @ by_out,
            "head_bias": by_out.sum(axis=0),
            "start": start,
        }
        for name, value in slopes.items():
            gradient[name][0] = scale * value
    return scale * total
