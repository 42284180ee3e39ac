"""Fits the parameters to a log: damped Gauss-Newton steps over rollouts, with what the log does not show.

The estimate is the most probable point under the priors, with Huber's weights on the residuals over the noise
that they show themselves. Its covariance is the sandwich over blocks of time: residuals that
correlate within a block widen it as far as they do. An error of the model that each block repeats would not:
the shift of the estimate under other models, to first order, is added to the variance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from slipgym._numba.compiled import patience
from slipgym.config.errors import unknown
from slipgym.identification.log import Log
from slipgym.identification.parameters import DEVIATION, NAMES, START, values_of
from slipgym.identification.rollout import CELLS, CHANNELS, FINE_CELLS, SUBSTEP, SURFACES, roll

HUBER = 2.0
"""Residual over the noise from which its weight falls [-]."""
BLOCK = 1.0
"""Length of the blocks, of which every `HELD_OUT`th is held out [s]."""
HELD_OUT = 4
SHOWN = 0.5
"""Largest deviation over the prior's with which a parameter counts as shown."""
STARTS, KEPT = 64, 6
"""Points sampled from the prior, and those from which a fit of a pad without cells begins."""
FAR = 3.0
"""Held-out residual over the noise from which the model does not fit the log [-]."""
IMPLAUSIBLE = 4.0
"""Distance from the prior, over its deviation, from which a value shows a fault of the log [-]."""
STEP = 1e-3
"""Of the finite differences, over the prior's deviation [-]."""
ITERATIONS = 15
"""Most steps of a fit."""
PRESSURES = "uniform", "hertz"
"""Pressures over a patch with cells; the fit takes the one that explains the log better."""


@dataclass(frozen=True)
class Result:
    """Parameters of a gripper found from a log; p of them in the order of `PARAMETERS`."""

    log: Log
    contact: str
    """Friction model of the fit."""
    pressure: str
    """Over a patch with cells."""
    point: np.ndarray
    """Transformed estimate, (p,); the prior's where the log does not show it."""
    deviation: np.ndarray
    """Its standard deviation, (p,)."""
    shown: np.ndarray
    """Whether the log shows the parameter, (p,)."""
    noise: np.ndarray
    """`Log.noise`: standard deviation of each reading's noise, (7,); NaN where it is absent."""
    held_out: np.ndarray
    """Root mean square of the residual of `after` on the held-out part, (7,)."""
    before: np.ndarray
    """Readings that the prior predicts, (n, 7)."""
    after: np.ndarray
    """Readings that `point` predicts, (n, 7)."""
    information: np.ndarray
    """Of the transformed parameters, priors included, (p, p)."""

    def interval(self) -> np.ndarray:
        """Lower and upper end of the 90 % interval of each value, (p, 2)."""
        ends = self.point + 1.645 * self.deviation * np.array([[-1.0], [1.0]])
        return values_of(ends).T

    def misfits(self) -> dict[str, float]:
        """Held-out residual over the noise, of the readings where it is above `FAR`."""
        ratios = self.held_out / self.noise
        return {name: float(each) for name, each in zip(CHANNELS, ratios, strict=True) if each > FAR}

    def implausible(self) -> dict[str, float]:
        """Distance from the prior over its deviation, of the parameters where it is above `IMPLAUSIBLE`."""
        away = np.abs(self.point - START) / DEVIATION
        return {name: float(each) for name, each in zip(NAMES, away, strict=True) if each > IMPLAUSIBLE}


@dataclass(frozen=True)
class _Problem:
    log: Log
    contact: str
    fitted: np.ndarray  # (n,) rows that the fit uses
    present: np.ndarray  # (7,)
    pressure: str = PRESSURES[0]
    cells: int = CELLS

    @cached_property
    def used(self) -> np.ndarray:
        """Readings that the fit uses, (n, present channels)."""
        return self.fitted[:, None] & np.isfinite(self.log.readings[:, self.present])

    @property
    def model(self) -> dict[str, Any]:
        """The model of the rollouts."""
        return {"contact": self.contact, "pressure": self.pressure, "cells": self.cells}

    def predict(self, points: np.ndarray, **other: Any) -> np.ndarray:
        """Readings of transformed points (m, p), of another model if given: (m, n, present channels)."""
        log, model = self.log, {**self.model, **other}
        all_of = roll(values_of(points), log.rate, log.command, log.motion, **model)
        return all_of[:, :, self.present]

    def residuals(self, predicted: np.ndarray) -> np.ndarray:
        """Log minus prediction in all rows; NaN where there is no reading."""
        return self.log.readings[:, self.present] - predicted

    def noise(self, residual: np.ndarray) -> np.ndarray:
        """Robust standard deviation of each channel's residual in the fitted rows."""
        part = residual[self.fitted]
        return np.maximum(1.4826 * np.nanmedian(np.abs(part - np.nanmedian(part, axis=0)), axis=0), 1e-9)

    def slopes(self, point: np.ndarray) -> np.ndarray:
        """Derivative of the readings by the transformed parameters, (p, n, present channels)."""
        log = self.log
        return slopes(point, log.rate, log.command, log.motion, **self.model)[:, :, self.present]


def slopes(
    point: np.ndarray, rate: float, command: np.ndarray, motion: np.ndarray, **model: Any
) -> np.ndarray:
    """Derivative of the readings by the transformed parameters, (p, n, 7), in one batch of rollouts."""
    points = np.vstack([point + np.diag(STEP * DEVIATION), point])
    ends = roll(values_of(points), rate, command, motion, **model)
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
    with patience("the rollouts"):
        roll(values_of(START[None]), log.rate, log.command[:2], log.motion[:2], contact)
    block = (np.arange(len(log.command)) / (BLOCK * log.rate)).astype(int)
    fitted = block % HELD_OUT != HELD_OUT - 1
    problem = _Problem(log, contact, fitted, np.asarray(np.isfinite(log.readings[fitted]).any(axis=0)))
    point = _start(problem, np.random.default_rng(seed))
    if contact == "distributed":
        problem, point = _finer(problem, point)
    else:
        point = _refined(problem, point)
    scale = problem.noise(problem.residuals(problem.predict(point[None])[0]))
    return _result(problem, _minimised(problem, point, scale), scale, block)


def _start(problem: _Problem, rng: np.random.Generator) -> np.ndarray:
    """The best of several fits of a disc, which costs a twentieth of a pad with cells and ends near it."""
    problem = replace(problem, contact="disc" if problem.contact == "distributed" else problem.contact)
    starts = START + DEVIATION * np.vstack([np.zeros(len(START)), rng.normal(size=(STARTS - 1, len(START)))])
    residuals = problem.residuals(problem.predict(starts))
    # one scale for all, or they could not be compared
    scale = np.min([problem.noise(each) for each in residuals], axis=0)
    costs = [_cost(problem, start, each, scale) for start, each in zip(starts, residuals, strict=True)]
    fits = np.array([_minimised(problem, starts[k], scale) for k in np.argsort(costs)[:KEPT]])
    scale = np.min([problem.noise(each) for each in problem.residuals(problem.predict(fits))], axis=0)
    fits = np.array([_minimised(problem, fit, scale) for fit in fits])
    residuals = problem.residuals(problem.predict(fits))
    return fits[np.argmin([_cost(problem, *each, scale) for each in zip(fits, residuals, strict=True)])]


def _refined(problem: _Problem, point: np.ndarray) -> np.ndarray:
    """The fit that begins at a point, with the scale of the residuals there."""
    return _minimised(problem, point, problem.noise(problem.residuals(problem.predict(point[None])[0])))


def _finer(problem: _Problem, point: np.ndarray) -> tuple[_Problem, np.ndarray]:
    """More cells, with the pressure that explains the log better, from the fit of few cells with either."""
    fits = [_refined(replace(problem, pressure=each), point) for each in PRESSURES]
    fine = [replace(problem, pressure=each, cells=FINE_CELLS) for each in PRESSURES]
    residuals = [each.residuals(each.predict(fit[None])[0]) for each, fit in zip(fine, fits, strict=True)]
    scale = np.min([problem.noise(each) for each in residuals], axis=0)
    best = np.argmin([_cost(problem, *each, scale) for each in zip(fits, residuals, strict=True)])
    return fine[best], fits[best]


def _cost(problem: _Problem, point: np.ndarray, residual: np.ndarray, scale: np.ndarray) -> float:
    size = np.abs(residual / scale)[problem.used]
    loss = np.where(size <= HUBER, 0.5 * size**2, HUBER * (size - 0.5 * HUBER)).sum()
    return float(loss + 0.5 * (((point - START) / DEVIATION) ** 2).sum())


def _normal_equations(
    problem: _Problem, slopes: np.ndarray, residual: np.ndarray, scale: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Information with the prior's (p, p), and the score of each row (p, n)."""
    residual = np.where(problem.used, residual, 0.0)
    weights = problem.used / np.maximum(np.abs(residual) / (HUBER * scale), 1.0)
    slopes = slopes / scale
    information = np.einsum("anc,nc,bnc->ab", slopes, weights, slopes, optimize=True)
    return information + np.diag(DEVIATION**-2.0), (slopes * (weights * residual / scale)).sum(axis=2)


def _minimised(problem: _Problem, point: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Levenberg and Marquardt's steps; five dampings are tried in one batch."""
    residual = problem.residuals(problem.predict(point[None])[0])
    cost = _cost(problem, point, residual, scale)
    damping, moved = 1e-3, True
    information = score = np.zeros(0)
    for _ in range(ITERATIONS):
        if moved:
            information, rows = _normal_equations(problem, problem.slopes(point), residual, scale)
            score = rows.sum(axis=1) - (point - START) / DEVIATION**2
        dampings = damping * 10.0 ** np.arange(-1.0, 4.0)
        diagonal = np.diag(np.diag(information))
        steps = np.array([np.linalg.solve(information + each * diagonal, score) for each in dampings])
        trials = point + np.clip(steps, -2.0 * DEVIATION, 2.0 * DEVIATION)
        residuals = problem.residuals(problem.predict(trials))
        costs = [_cost(problem, *each, scale) for each in zip(trials, residuals, strict=True)]
        k = int(np.argmin(costs))
        moved = costs[k] < cost
        if not moved:
            damping = dampings[-1]
            if damping > 1e6:
                break
            continue
        gain, cost, point, damping, residual = cost - costs[k], costs[k], trials[k], dampings[k], residuals[k]
        if gain < 1e-2:  # of the log-likelihood: a seventh of a standard deviation
            break
    return point


def _result(problem: _Problem, point: np.ndarray, scale: np.ndarray, block: np.ndarray) -> Result:
    other = next(each for each in PRESSURES if each != problem.pressure)
    models: tuple[dict[str, Any], ...] = (
        {},
        {"pressure": other},
        {"substep": 0.5 * SUBSTEP},
        {"contact": "disc"},
    )
    residuals = [problem.residuals(problem.predict(point[None], **model)[0]) for model in models]
    slopes = problem.slopes(point)
    (information, rows), *others = [_normal_equations(problem, slopes, each, scale) for each in residuals]
    # priors are information of their own; each block's score counts whole, so what correlates in it adds up
    sums = np.array([np.bincount(block, weights=row) for row in rows])[:, np.unique(block[problem.fitted])]
    blocks = sums.shape[1]
    meat = sums @ sums.T * blocks / max(blocks - 1, 1) + np.diag(DEVIATION**-2.0)
    inverse = np.linalg.inv(information)
    variance = np.maximum(np.diag(inverse @ meat @ inverse), np.diag(inverse))
    shifts = np.array([inverse @ (other - rows).sum(axis=1) for _, other in others])
    deviation = np.sqrt(variance + (shifts**2).sum(axis=0))
    shown = deviation < SHOWN * DEVIATION
    log, written = problem.log, np.where(shown, point, START)
    points = values_of(np.stack([START, written]))
    before, after = roll(points, log.rate, log.command, log.motion, **problem.model)
    left = np.ma.masked_invalid((log.readings - after)[~problem.fitted])
    return Result(
        log=log,
        contact=problem.contact,
        pressure=problem.pressure,
        point=written,
        deviation=np.where(shown, deviation, DEVIATION),
        shown=shown,
        noise=log.noise(),
        held_out=np.sqrt((left**2).mean(axis=0).filled(np.nan)),
        before=before,
        after=after,
        information=information,
    )
