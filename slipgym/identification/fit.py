"""Fits the parameters to a log: damped Gauss-Newton steps over rollouts, with what the log does not show.

The estimate is the most probable point under the priors, with Huber's weights on the residuals over the noise
that they show themselves. Its covariance is the sandwich over blocks of time: residuals that
correlate within a block widen it as far as they do. An error of the model that each block repeats would not:
the shift of the estimate under each of `ALTERNATIVES`, to first order, is added to the variance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from slipgym.config.errors import unknown
from slipgym.identification.log import Log
from slipgym.identification.parameters import DEVIATION, NAMES, START, values_of
from slipgym.identification.rollout import SUBSTEP, SURFACES, roll

HUBER = 2.0
"""Residual over the noise from which its weight falls [-]."""
BLOCK = 1.0
"""Length of the blocks, of which every `HELD_OUT`th is held out [s]."""
HELD_OUT = 4
SHOWN = 0.5
"""Largest deviation over the prior's with which a parameter counts as shown."""
STARTS, KEPT = 24, 2
"""Points sampled from the prior, and those from which a fit begins."""
STEP = 1e-3
"""Of the finite differences, over the prior's deviation [-]."""
EARLY, ITERATIONS = 8, 15
"""Most steps of a fit from a start, and of the last ones."""
ALTERNATIVES = ({"pressure": "hertz"}, {"substep": 0.5 * SUBSTEP}, {"contact": "disc"})
"""Models that a log may as well come from: the pressure of the patch and the sub-step are choices."""


@dataclass(frozen=True)
class Result:
    """What a log shows of a gripper; p parameters in the order of `PARAMETERS`."""

    log: Log
    contact: str
    """Friction model of the fit."""
    point: np.ndarray
    """Transformed estimate, (p,); the prior's where the log does not show it."""
    deviation: np.ndarray
    """Its standard deviation, (p,)."""
    shown: np.ndarray
    """Whether the log shows the parameter, (p,)."""
    noise: np.ndarray
    """Standard deviation of each reading's noise, (7,); NaN where it is absent."""
    held_out: np.ndarray
    """Root mean square of each reading's residual on the held-out part, (7,)."""
    before: np.ndarray
    """Readings that the prior predicts, (n, 7)."""
    after: np.ndarray
    """Readings that the estimate predicts, (n, 7)."""
    information: np.ndarray
    """Of the transformed parameters, priors included, (p, p)."""

    def interval(self) -> np.ndarray:
        """Lower and upper end of the 90 % interval of each value, (p, 2)."""
        ends = self.point + 1.645 * self.deviation * np.array([[-1.0], [1.0]])
        return values_of(ends).T


@dataclass(frozen=True)
class _Problem:
    log: Log
    contact: str
    fitted: np.ndarray  # (n,) rows that the fit uses
    present: np.ndarray  # (7,)

    def predict(self, points: np.ndarray, **other: Any) -> np.ndarray:
        """Readings of transformed points (m, p), of another model if given: (m, n, present channels)."""
        log, model = self.log, {"contact": self.contact, **other}
        all_of = roll(values_of(points), log.rate, log.command, log.motion, **model)
        return all_of[:, :, self.present]

    def residuals(self, predicted: np.ndarray) -> np.ndarray:
        """Log minus prediction in all rows."""
        return self.log.readings[:, self.present] - predicted

    def noise(self, residual: np.ndarray) -> np.ndarray:
        """Robust standard deviation of each channel's residual in the fitted rows."""
        part = residual[self.fitted]
        return np.maximum(1.4826 * np.median(np.abs(part - np.median(part, axis=0)), axis=0), 1e-9)

    def slopes(self, point: np.ndarray) -> np.ndarray:
        """Derivative of the readings by the transformed parameters, (p, n, channels): one batch."""
        ends = self.predict(np.vstack([point + np.diag(STEP * DEVIATION), point]))
        return (ends[:-1] - ends[-1]) / (STEP * DEVIATION)[:, None, None]


def identify(log: Log, contact: str = "distributed", seed: int = 0) -> Result:
    """Fits all parameters to a log.

    Args:
        log: The log.
        contact: Friction model of the pads, "distributed", "disc" or "ellipsoid".
        seed: Of the points from which fits begin.

    Raises:
        ValueError: The contact is unknown, or nothing in the log moves or presses.
    """
    if contact not in SURFACES:
        raise ValueError(unknown("contact", contact, SURFACES))
    if np.ptp(log.readings[:, :4], axis=0).max() == 0.0:
        raise ValueError("the log's wrench never changes: nothing in it can be identified")
    block = (np.arange(len(log.command)) / (BLOCK * log.rate)).astype(int)
    problem = _Problem(log, contact, block % HELD_OUT != HELD_OUT - 1, np.isfinite(log.readings).all(axis=0))
    rng = np.random.default_rng(seed)
    starts = START + DEVIATION * np.vstack([np.zeros(len(START)), rng.normal(size=(STARTS - 1, len(START)))])
    residuals = problem.residuals(problem.predict(starts))
    scale = np.min([problem.noise(each) for each in residuals], axis=0)
    costs = [_cost(problem, start, each, scale) for start, each in zip(starts, residuals, strict=True)]
    best = [starts[k] for k in np.argsort(costs)[:KEPT]]
    fits = [_minimised(problem, start, scale, EARLY) for start in best]
    # one scale for all, or they could not be compared
    costs = [
        _cost(problem, point, problem.residuals(problem.predict(point[None])[0]), scale) for point in fits
    ]
    point = fits[int(np.argmin(costs))]
    for _ in range(2):
        scale = problem.noise(problem.residuals(problem.predict(point[None])[0]))
        point = _minimised(problem, point, scale)
    return _result(problem, point, scale, block)


def _weights(residual: np.ndarray, scale: np.ndarray) -> np.ndarray:
    return 1.0 / np.maximum(np.abs(residual) / (HUBER * scale), 1.0)


def _cost(problem: _Problem, point: np.ndarray, residual: np.ndarray, scale: np.ndarray) -> float:
    size = np.abs(residual[problem.fitted] / scale)
    loss = np.where(size <= HUBER, 0.5 * size**2, HUBER * (size - 0.5 * HUBER)).sum()
    return float(loss + 0.5 * (((point - START) / DEVIATION) ** 2).sum())


def _normal_equations(
    problem: _Problem, point: np.ndarray, scale: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Information (p, p), score (p,), and the score of each row (p, n)."""
    residual = problem.residuals(problem.predict(point[None])[0])
    weights = np.where(problem.fitted[:, None], _weights(residual, scale), 0.0)
    slopes = problem.slopes(point) / scale
    rows = (slopes * (weights * residual / scale)).sum(axis=2)
    information = np.einsum("anc,nc,bnc->ab", slopes, weights, slopes, optimize=True)
    score = rows.sum(axis=1) - (point - START) / DEVIATION**2
    return information + np.diag(DEVIATION**-2.0), score, rows


def _score(problem: _Problem, point: np.ndarray, scale: np.ndarray, other: dict[str, Any]) -> np.ndarray:
    """Score of the data (p,) if another model predicts the readings."""
    residual = problem.residuals(problem.predict(point[None], **other)[0])
    weights = np.where(problem.fitted[:, None], _weights(residual, scale), 0.0)
    return np.einsum("anc,nc->a", problem.slopes(point) / scale, weights * residual / scale)


def _minimised(
    problem: _Problem, point: np.ndarray, scale: np.ndarray, iterations: int = ITERATIONS
) -> np.ndarray:
    """Levenberg and Marquardt's steps; five dampings are tried in one batch."""
    cost = _cost(problem, point, problem.residuals(problem.predict(point[None])[0]), scale)
    damping = 1e-3
    for _ in range(iterations):
        information, score, _ = _normal_equations(problem, point, scale)
        dampings = damping * 10.0 ** np.arange(-1.0, 4.0)
        diagonal = np.diag(np.diag(information))
        steps = np.array([np.linalg.solve(information + each * diagonal, score) for each in dampings])
        trials = point + np.clip(steps, -2.0 * DEVIATION, 2.0 * DEVIATION)
        predicted = problem.predict(trials)
        costs = [
            _cost(problem, t, problem.residuals(p), scale) for t, p in zip(trials, predicted, strict=True)
        ]
        k = int(np.argmin(costs))
        if not costs[k] < cost:
            damping = dampings[-1]
            if damping > 1e6:
                break
            continue
        gain, cost, point, damping = cost - costs[k], costs[k], trials[k], dampings[k]
        if gain < 1e-3:
            break
    return point


def _result(problem: _Problem, point: np.ndarray, scale: np.ndarray, block: np.ndarray) -> Result:
    information, _, rows = _normal_equations(problem, point, scale)
    # priors are information of their own; each block's score counts whole, so what correlates in it adds up
    sums = np.array([np.bincount(block, weights=row) for row in rows])[:, np.unique(block[problem.fitted])]
    blocks = sums.shape[1]
    meat = sums @ sums.T * blocks / max(blocks - 1, 1) + np.diag(DEVIATION**-2.0)
    inverse = np.linalg.inv(information)
    sandwich = inverse @ meat @ inverse
    deviation = np.sqrt(np.maximum(np.diag(sandwich), np.diag(inverse)))
    shifts = np.array([inverse @ _score(problem, point, scale, other) for other in ALTERNATIVES])
    shifts -= inverse @ _score(problem, point, scale, {})
    deviation = np.sqrt(deviation**2 + (shifts**2).sum(axis=0))
    shown = deviation < SHOWN * DEVIATION
    after = problem.predict(point[None])[0]
    residual = problem.residuals(after)
    full = np.full((2, problem.log.readings.shape[1]), np.nan)
    full[:, problem.present] = scale, np.sqrt((residual[~problem.fitted] ** 2).mean(axis=0))
    log = problem.log
    before, found = roll(
        values_of(np.stack([START, point])), log.rate, log.command, log.motion, problem.contact
    )
    return Result(
        log=log,
        contact=problem.contact,
        point=np.where(shown, point, START),
        deviation=np.where(shown, deviation, DEVIATION),
        shown=shown,
        noise=full[0],
        held_out=full[1],
        before=before,
        after=found,
        information=information,
    )


def value(result: Result, name: str) -> float:
    """The estimate of a parameter, or its prior's median."""
    return float(values_of(result.point)[NAMES.index(name)])
