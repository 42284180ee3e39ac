"""Means with intervals of a stratified bootstrap over paired episodes.

After Agarwal et al., Deep Reinforcement Learning at the Edge of the Statistical Precipice (NeurIPS 2021):
percentile intervals from a bootstrap within strata. Their interquartile mean is for seeds; over episodes it
would leave the failures out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import trim_mean

from policies.evaluation.statistics import CONFIDENCE, Interval

RESAMPLES = 4000


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
        low, high = np.quantile(self.draws, ends, method="inverted_cdf")
        return Interval(self.value, float(low), float(high))


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


def over_seeds(shares: Sequence[float]) -> Interval:
    """Interquartile mean over training seeds, with the percentile interval of a bootstrap over the seeds.

    Args:
        shares: Success of each seed's policy. A single one has no interval (NaN).
    """
    found = np.asarray(shares, dtype=np.float64)
    if len(found) == 1:
        return Interval(float(found[0]), np.nan, np.nan)
    chosen = np.random.default_rng(0).choice(found, (RESAMPLES, len(found)))
    return Drawn(float(trim_mean(found, 0.25)), trim_mean(chosen, 0.25, axis=1)).interval
