"""One step of the network of "gru": a gated recurrent unit whose gates average measurements.

The unit is that of Cho et al. (Learning phrase representations using RNN encoder-decoder for statistical
machine translation, EMNLP 2014), in the form of `torch.nn.GRU`. Of its hidden state h and the columns x it
computes for each target a measurement c and a weight g in (0, 1), and averages: m += g (c - m). Only linear
operations lie between a measurement and its average, so precision does not depend on the size of h. All
numbers are float32, and sums run in a fixed order.
"""

import math

import numpy as np

from estimator._numba.caching import njit
from lab.learned_estimator.features import COLUMNS

HIDDEN = 40
"""Size of the hidden state."""
MU_S, MU_C, R = 0, 1, 2
"""Targets: logarithms of mu_s, mu_c and r [m]."""
TARGETS = 3
LEVER = 3
"""Number of the deviation of ln(mu_c r); those before it are of the targets."""
OUTPUTS = 2 * TARGETS + TARGETS + 1
"""Weights and measurements of the targets, then the deviations."""
SMALLEST, LARGEST = 0.01, 1.0
"""Range of the relative standard deviations [-]."""
LOW, HIGH = np.float32(math.log(SMALLEST)), np.float32(math.log(LARGEST))
"""Range of their logarithms."""
ONE = np.float32(1.0)


@njit(error_model="numpy")
def logistic(x):
    """1 / (1 + exp(-x)) in float32."""
    return ONE / (ONE + math.exp(-x))


@njit(error_model="numpy")
def accumulate(out, x, weight, n):
    """Adds x weight to out, for x (n,) and weight (n, m): row by row, which fixes the order of the sums."""
    for j in range(n):
        row, factor = weight[j], x[j]
        for i in range(row.shape[0]):
            out[i] += factor * row[i]


@njit(error_model="numpy")
def working_arrays():
    """Arrays of one step: columns, gates, their parts from the hidden state, outputs. See `advance`."""
    return (
        np.zeros(COLUMNS, np.float32),
        np.zeros(3 * HIDDEN, np.float32),
        np.zeros(3 * HIDDEN, np.float32),
        np.zeros(OUTPUTS, np.float32),
    )


@njit(error_model="numpy")
def advance(p, scratch, hidden, mean):
    """Takes the columns of a sample into the hidden state and the averages.

    Args:
        p: Record with the tensors of `lab.learned_estimator.weights.SHAPES`.
        scratch: From `working_arrays`. The first holds the columns, which are normalised in place. The others
            are written: the gates reset, update and new (3 HIDDEN,); what the hidden state adds to their
            arguments (3 HIDDEN,); weights, measurements and logarithms of relative standard deviations,
            (OUTPUTS,).
        hidden: Hidden state (HIDDEN,), changed in place.
        mean: Averages (TARGETS,), changed in place.
    """
    x, gates, by_h, out = scratch
    for k in range(COLUMNS):
        x[k] = (x[k] - p.centre[k]) * p.scale[k]
    for i in range(3 * HIDDEN):
        gates[i], by_h[i] = p.input_bias[i], p.hidden_bias[i]
    accumulate(gates, x, p.input_weight, COLUMNS)
    accumulate(by_h, hidden, p.hidden_weight, HIDDEN)
    for i in range(HIDDEN):
        reset = logistic(gates[i] + by_h[i])
        update = logistic(gates[HIDDEN + i] + by_h[HIDDEN + i])
        new = math.tanh(gates[2 * HIDDEN + i] + reset * by_h[2 * HIDDEN + i])
        gates[i], gates[HIDDEN + i], gates[2 * HIDDEN + i] = reset, update, new
        hidden[i] = new + update * (hidden[i] - new)
    for i in range(OUTPUTS):
        out[i] = p.head_bias[i]
    accumulate(out, hidden, p.head_of_hidden, HIDDEN)
    accumulate(out, x, p.head_of_columns, COLUMNS)
    for i in range(TARGETS):
        out[i] = logistic(out[i])
        mean[i] += out[i] * (out[TARGETS + i] - mean[i])
    for i in range(2 * TARGETS, OUTPUTS):
        out[i] = LOW + (HIGH - LOW) * logistic(out[i])
