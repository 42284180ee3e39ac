"""Compares policies with friction to the strongest one without it, on the same episodes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd

from policies.evaluation.frames import groups, values
from policies.evaluation.statistics import Interval, mean_interval

WITHOUT = "none", "nominal"
"""Friction sources of a policy without friction."""
_EPISODE = ["material", "options", "trial"]


class Entry(NamedTuple):
    """A policy with a friction choice, in all its episodes."""

    name: str
    """How figures call it."""
    source: str
    """Its friction source."""
    rows: np.ndarray
    """Its rows of the table of trials, in the order of the episodes, (n,)."""
    success: np.ndarray
    """Whether it solved them, (n,) bool."""
    reward: np.ndarray
    """Their returns, (n,)."""


class Gain(NamedTuple):
    """What friction is worth in an experiment."""

    entries: tuple[Entry, ...]
    """The policies without friction, the strongest last; then the strongest with estimated and with true
    friction, if there is one."""
    opponent: Entry
    """The strongest without friction."""
    estimated: Entry
    """The strongest with estimated friction."""
    points: Interval
    """Episodes that `estimated` solves less those of `opponent`, with the interval over pairs [%]."""

    def episode(self) -> int:
        """Number of an episode that all policies with friction solve and the fewest of the others.

        Of several it is the one in which the estimate gains most return.
        """
        within = [entry.success for entry in self.entries if entry.source not in WITHOUT]
        others = [entry.success for entry in self.entries if entry.source in WITHOUT]
        rank = np.sum(others, axis=0) - len(others) * np.all(within, axis=0)
        return int(np.lexsort((self.opponent.reward - self.estimated.reward, rank))[0])

    def words(self) -> str:
        """The comparison in two sentences."""
        true = [entry for entry in self.entries if entry.source == "true"]
        return sentence(
            len(self.estimated.success),
            int(self.estimated.success.sum()),
            (self.opponent.name, int(self.opponent.success.sum())),
            int(true[0].success.sum()) if true else None,
            self.points,
        )


def compare(trials: pd.DataFrame) -> Gain | None:
    """Finds the strongest policy without friction, and what the estimate gains over it.

    The strongest solves most, among equals it collects most.

    Args:
        trials: The table of trials.

    Returns:
        None if no policy has estimated friction, or none is without.
    """
    trials = trials.reset_index(drop=True)
    found = [
        _entry(policy, source, group)
        for (policy, _, source), group in groups(trials, ["policy", "friction", "friction_source"])
    ]
    found.sort(key=lambda entry: (entry.success.mean(), entry.reward.mean()))
    without = [entry for entry in found if entry.source in WITHOUT]
    best = {entry.source: entry for entry in found}
    if not without or "estimated" not in best:
        return None
    opponent, estimated = without[-1], best["estimated"]
    points = mean_interval(100.0 * estimated.success - 100.0 * opponent.success)
    strongest = (best[source] for source in ("estimated", "true") if source in best)
    return Gain((*without, *strongest), opponent, estimated, points)


def sentence(
    episodes: int, estimated: int, opponent: tuple[str, int], true: int | None, points: Interval
) -> str:
    """What friction is worth, in words.

    Args:
        episodes: How many each policy played.
        estimated: How many of them are solved with estimated friction.
        opponent: Name of the strongest policy without friction, and how many it solves.
        true: How many are solved with true friction; None: nobody had it.
        points: The gain with its interval [%].
    """
    name, solved = opponent
    with_truth = "" if true is None else f", {true} with the truth"
    return (
        f"Of {episodes} episodes, {estimated} are solved with estimated friction, {solved} by the strongest "
        f"policy without friction ({name}){with_truth}. The estimate {_change(points)}."
    )


def _change(points: Interval) -> str:
    """A gain or loss with its interval, of which a single episode has none."""
    verb, ends = "gains", points
    if points.value < 0.0:
        verb, ends = "loses", Interval(-points.value, -points.high, -points.low)
    if np.isnan(points.low):
        return f"{verb} {round(ends.value)} points"
    value, low, high = (f"{round(end)}".replace("-", "−") for end in ends)
    return f"{verb} {value} points ({low} to {high})"


def _entry(policy: str, source: str, group: pd.DataFrame) -> Entry:
    group = group.sort_values(_EPISODE, kind="stable")
    plain = {"none": policy, "nominal": f"{policy}, nominal friction"}
    success = values(group, "success").astype(bool)
    return Entry(
        plain.get(source, f"{source} friction"),
        source,
        np.asarray(group.index),
        success,
        values(group, "return"),
    )
