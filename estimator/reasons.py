"""Says in a sentence why an estimate is not to be relied on."""

from typing import NamedTuple

import numpy as np

from estimator.estimate import Estimate

CONFIDENT = 0.5
"""Confidence from which a value needs no reason."""
DOUBT = 0.1
"""Standard deviation over the value from which it is named."""
MISFIT = 2.0
"""Mean squared normalised residual from which the law does not explain the data; noise makes it 1 ± 0.13."""
AT_BOUND = 0.5
"""Share of r at a bound from which that is named."""

COUNTS = {"mu_s": "events_mu_s", "mu_c": "updates_mu_c", "r": "updates_r"}
"""Value -> field of an estimate that counts the data behind it."""
NEEDS = {
    "mu_s": "it needs slips that start or stop in contact",
    "mu_c": "it needs slip with translation in it",
    "r": "it needs slip with rotation in it",
}
"""The motion that shows a value."""


BLIND = {
    1: "these sensors measure no slip velocity, so that a slip shows in a sudden fall of the load alone",
    2: "these sensors measure neither slip nor tangential force: nothing in them depends on friction",
}
"""What is not measured -> why no motion shows the value."""


class Doubts(NamedTuple):
    """Evidence against an estimate that its own fields do not show, as far as the estimator keeps it."""

    misfit: float = 1.0
    """Mean squared normalised residual."""
    at_bound: float = 0.0
    """1 while r is at its upper bound."""
    unmeasured: float = 0.0
    """Of the readings: 0 all are measured, 1 no slip velocity, 2 no tangential force either."""


def doubts(state: np.void) -> Doubts:
    """By the state of any estimator."""
    kept = state.dtype.names or ()
    return Doubts(**{name: float(state[name]) for name in Doubts._fields if name in kept})


def reasons(
    estimate: Estimate, misfit: float = 1.0, at_bound: float = 0.0, unmeasured: float = 0.0
) -> dict[str, str]:
    """Reasons for little confidence in values.

    Args:
        estimate: What an estimator published.
        misfit: Mean squared normalised residual, if the estimator keeps it: the state `misfit` of "adaptive".
        at_bound: See `Doubts`.
        unmeasured: See `Doubts`.

    Returns:
        Of "mu_s", "mu_c" and "r" those with a confidence below one half, each with the reason, and with the
        motion that it needs.
    """
    found = {}
    for name, whys in causes(estimate, misfit, at_bound).items():
        if getattr(estimate, f"confidence_{name}") >= CONFIDENT:
            continue
        data, needs = int(getattr(estimate, COUNTS[name])), BLIND.get(int(unmeasured), NEEDS[name])
        if not data:
            found[name] = f"{whys[0]}: this is the start value; {needs}"
        else:
            found[name] = f"{', '.join(whys) or f'little data ({data})'}: be cautious; {needs}"
    return found


def causes(estimate: Estimate, misfit: float = 1.0, at_bound: float = 0.0) -> dict[str, tuple[str, ...]]:
    """Evidence against each of "mu_s", "mu_c" and "r", whatever its confidence; the most important first.

    The arguments are those of `reasons`.
    """
    found = {}
    contradict = estimate.events_mu_s > 0 < estimate.updates_mu_c and estimate.mu_s == estimate.mu_c
    for name, count in COUNTS.items():
        if not getattr(estimate, count):
            found[name] = ("not observed",)
            continue
        doubt, why = float(getattr(estimate, f"sd_{name}")) / float(getattr(estimate, name)), []
        if doubt > DOUBT:
            why.append(f"one standard deviation is {100.0 * doubt:.0f} %")
        if contradict and name != "r":
            why.append("mu_s not above mu_c: both are their mean")
        if at_bound > AT_BOUND and name == "r":
            why.append("the slips ask for an r beyond its bounds: r_max is the pad's radius")
        if misfit > MISFIT and name != "mu_s":
            why.append(f"residuals are {misfit**0.5:.1f} times what noise explains")
        found[name] = tuple(why)
    return found
