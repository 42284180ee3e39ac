"""Compares policies with friction to the strongest one without it and to the truth, on the same episodes."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import NamedTuple

import numpy as np
import pandas as pd

from policies.evaluation.frames import groups, text, values
from policies.evaluation.statistics import Interval, mean_interval

WITHOUT = "none", "nominal"
"""Friction sources of a policy without friction."""
TRUTH = "Estimated against true friction, episode by episode"
"""Title of the table `against_truth`."""
_EPISODE = ["material", "options", "trial"]


class Entry(NamedTuple):
    """A policy with a friction choice, in all its episodes."""

    policy: str
    """How tables call the policy."""
    source: str
    """Its friction source."""
    success: np.ndarray
    """Whether it solved them, (n,) bool."""
    reward: np.ndarray
    """Their returns, (n,)."""
    friction: str = ""
    """How tables call the friction choice."""
    rows: np.ndarray = np.empty(0, np.int64)
    """Its rows of the table of trials, in the order of the episodes, (n,)."""

    @property
    def name(self) -> str:
        """Name in figures."""
        plain = {"none": self.policy, "nominal": f"{self.policy}, nominal friction"}
        return plain.get(self.source, f"{self.source} friction")


class Gain(NamedTuple):
    """Gain of an experiment by estimated friction."""

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
        solved = {entry.source: int(entry.success.sum()) for entry in self.entries}
        opponent = self.opponent.name, int(self.opponent.success.sum())
        n = len(self.estimated.success)
        return sentence(n, solved["estimated"], opponent, solved.get("true"), self.points)


def ranked(entries: Iterable[Entry], sources: Container[str]) -> list[Entry]:
    """The policies with these friction sources; the last solves most and, among equals, collects most."""
    among = [entry for entry in entries if entry.source in sources]
    return sorted(among, key=lambda entry: (entry.success.mean(), entry.reward.mean()))


def difference(one: Entry, other: Entry) -> Interval:
    """Episodes that one solves less those of the other, with the interval over pairs [%]."""
    return mean_interval(100.0 * one.success - 100.0 * other.success)


def compare(trials: pd.DataFrame) -> Gain | None:
    """Finds the strongest policy without friction in a table of trials, and what the estimate gains over it.

    None if no policy has estimated friction, or none is without.
    """
    entries = _entries(trials)
    without = ranked(entries, WITHOUT)
    estimated, true = (ranked(entries, [source])[-1:] for source in ("estimated", "true"))
    if not without or not estimated:
        return None
    return Gain(
        (*without, *estimated, *true), without[-1], estimated[0], difference(estimated[0], without[-1])
    )


def against_truth(trials: pd.DataFrame) -> pd.DataFrame:
    """Success of each policy with estimated friction beside that of the same policy with the truth, in words.

    A row for each policy and choice of estimated friction in a table of trials: episodes that both solve,
    only one of them and neither, and the difference with its interval over pairs. No rows without such pairs.
    """
    rows, entries = [], _entries(trials)
    truth = {entry.policy: entry for entry in reversed(entries) if entry.source == "true"}
    for entry in entries:
        if entry.source == "estimated" and (true := truth.get(entry.policy)) is not None:
            either = 2 * entry.success + true.success
            counts = (int(np.sum(either == each)) for each in (3, 2, 1, 0))
            points = text([0.01 * end for end in difference(entry, true)], "[%]")
            rows.append((entry.policy, entry.friction, *counts, points))
    cells = ["both solve", "estimate alone", "truth alone", "neither", "estimate less truth [points]"]
    return pd.DataFrame(rows, columns=pd.Index(["policy", "friction", *cells]))


def sentence(
    episodes: int, estimated: int, opponent: tuple[str, int], true: int | None, points: Interval
) -> str:
    """The gain by estimated friction, in words.

    Args:
        episodes: How many each policy played.
        estimated: How many of them are solved with estimated friction.
        opponent: Name of the strongest policy without friction, and how many it solves.
        true: How many are solved with true friction; None: nobody had it.
        points: The gain with its interval [%].
    """
    name, solved = opponent
    with_truth = "" if true is None else f", {true} with the truth"
    verb, ends = "gains", points
    if points.value < 0.0:
        verb, ends = "loses", Interval(-points.value, -points.high, -points.low)
    between = ""  # a single episode has no interval
    if not np.isnan(points.low):
        between = " ({} to {})".format(*(f"{round(end)}".replace("-", "−") for end in ends[1:]))
    return (
        f"Of {episodes} episodes, {estimated} are solved with estimated friction, {solved} by the strongest "
        f"policy without friction ({name}){with_truth}. "
        f"The estimate {verb} {round(ends.value)} points{between}."
    )


def _entries(trials: pd.DataFrame) -> list[Entry]:
    """The policies and friction choices of a table of trials, each with its episodes in the same order."""
    found = []
    trials = trials.reset_index(drop=True).sort_values(_EPISODE, kind="stable")
    for (policy, friction, source), group in groups(trials, ["policy", "friction", "friction_source"]):
        success = values(group, "success").astype(bool)
        found.append(
            Entry(policy, source, success, values(group, "return"), friction, np.asarray(group.index))
        )
    return found
