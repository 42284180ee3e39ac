"""Computes intervals of 95 %: Wilson's for shares, one bootstrap over episodes for means, gains and ratios.

The bootstrap resamples whole episodes, each stratum by itself, and takes percentiles (Agarwal et al., Deep
Reinforcement Learning at the Edge of the Statistical Precipice, NeurIPS 2021). It serves every comparison
because its resamples depend on the strata alone: two policies get the same episodes, so a gain has an
interval over pairs, and so has a gain over another gain. A normal interval has no such ratio, that of
`scipy.stats.bootstrap` no strata. Their interquartile mean is for seeds; over episodes it would leave the
failures out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import stats

CONFIDENCE = 0.95
RESAMPLES = 4000


class Interval(NamedTuple):
    """An estimate and its confidence interval."""

    value: float
    low: float
    high: float

    @property
    def percent(self) -> Interval:
        """The same of a share [%]."""
        return Interval(*(100.0 * end for end in self))


@dataclass(frozen=True)
class Drawn:
    """A figure and its values over the resamples; figures of the same resamples can be combined."""

    value: float
    draws: np.ndarray

    def __sub__(self, other: Drawn) -> Drawn:
        return Drawn(self.value - other.value, self.draws - other.draws)

    def share_of(self, whole: Drawn) -> Drawn:
        """This over a whole; a resample whose whole is not positive counts as minus infinity."""
        positive = whole.draws > 0.0
        draws = np.full(len(positive), -np.inf)
        np.divide(self.draws, whole.draws, out=draws, where=positive)
        return Drawn(self.value / whole.value, draws)

    @property
    def interval(self) -> Interval:
        """The figure with its percentile interval."""
        ends = (1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0
        return Interval(self.value, *np.quantile(self.draws, ends, method="inverted_cdf").tolist())


class Bootstrap:
    """Resamples of episodes, each stratum by itself; the same for every condition, so that pairs stay pairs.

    A stratum of a single episode says nothing about its spread: then there are no intervals (NaN).

    Args:
        strata: The stratum of each episode, (n,).
    """

    def __init__(self, strata: np.ndarray) -> None:
        rng = np.random.default_rng(0)
        self._at = np.empty((RESAMPLES, len(strata)), dtype=np.int64)
        names, sizes = np.unique(strata, return_counts=True)
        self._spread = 1.0 if sizes.min() > 1 else np.nan
        for stratum in names:
            members = np.flatnonzero(strata == stratum)
            self._at[:, members] = rng.choice(members, (RESAMPLES, len(members)))

    def __call__(self, values: np.ndarray) -> Drawn:
        """The mean over the episodes, (n,), in the order of the strata."""
        values = np.asarray(values, dtype=np.float64)
        return Drawn(float(values.mean()), self._spread * values[self._at].mean(axis=-1))


_alike = lru_cache(maxsize=1)(lambda n: Bootstrap(np.zeros(n)))


def mean_interval(values: np.ndarray) -> Interval:
    """Mean with its bootstrap interval; the bounds are NaN for fewer than two values.

    Args:
        values: One per trial, or one per pair of them, (n,); NaNs are left out.
    """
    values = np.asarray(values, dtype=np.float64)
    values = values[~np.isnan(values)]
    if not len(values):
        return Interval(math.nan, math.nan, math.nan)
    mean = values.mean().item()
    if len(values) > 1 and np.ptp(values) <= 1e-12 * np.abs(values).max():
        return Interval(mean, mean, mean)
    return _alike(len(values))(values).interval


def share_interval(successes: int, n: int) -> Interval:
    """Share of n trials with its Wilson interval.

    Raises:
        ValueError: n is not positive, or there are more successes than trials.
    """
    if n < 1 or not 0 <= successes <= n:
        raise ValueError(f"{successes} of {n} is no share of trials")
    interval = stats.binomtest(successes, n).proportion_ci(CONFIDENCE, method="wilson")
    return Interval(successes / n, float(interval.low), float(interval.high))


def share(happened: np.ndarray) -> Interval:
    """Share of the trials in which something happened, (n,) bool, with its Wilson interval."""
    return share_interval(int(np.sum(happened)), len(happened))


def over_seeds(shares: Sequence[float]) -> Interval:
    """Interquartile mean over training seeds, with the percentile interval of a bootstrap over the seeds.

    Args:
        shares: Success of each seed's policy. A single one has no interval (NaN).
    """
    found = np.asarray(shares, dtype=np.float64)
    if len(found) == 1:
        return Interval(float(found[0]), np.nan, np.nan)
    chosen = np.random.default_rng(0).choice(found, (RESAMPLES, len(found)))
    return Drawn(float(stats.trim_mean(found, 0.25)), stats.trim_mean(chosen, 0.25, axis=1)).interval


def spread(figures: Mapping[str, Interval | Drawn]) -> dict[str, float]:
    """Figures with the ends of their intervals as columns of a table."""
    row: dict[str, float] = {}
    for name, figure in figures.items():
        value, low, high = figure.interval if isinstance(figure, Drawn) else figure
        row |= {name: value, f"{name}_low": low, f"{name}_high": high}
    return row
