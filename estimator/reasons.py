"""Says in a sentence why an estimate is not to be relied on."""

from estimator.estimate import Estimate

CONFIDENT = 0.5
"""Confidence from which a value needs no reason."""
DOUBT = 0.1
"""Standard deviation over the value from which it is named."""
MISFIT = 2.0
"""Mean squared normalised residual from which the law does not explain the data; noise makes it 1 ± 0.13."""

COUNTS = {"mu_s": "events_mu_s", "mu_c": "updates_mu_c", "r": "updates_r"}
"""Value -> field of an estimate that counts the data behind it."""
_NEEDS = {
    "mu_s": "it needs slips that start or stop in contact",
    "mu_c": "it needs slip with translation in it",
    "r": "it needs slip with rotation in it",
}


def reasons(estimate: Estimate, misfit: float = 1.0) -> dict[str, str]:
    """Why values have little confidence.

    Args:
        estimate: What an estimator published.
        misfit: Mean squared normalised residual, if the estimator keeps it: the state `misfit` of "adaptive".

    Returns:
        Of "mu_s", "mu_c" and "r" those with a confidence below one half, each with the reason, and with the
        motion that it needs.
    """
    found = {}
    contradict = estimate.events_mu_s > 0 < estimate.updates_mu_c and estimate.mu_s == estimate.mu_c
    for name, count in COUNTS.items():
        data, value = int(getattr(estimate, count)), float(getattr(estimate, name))
        if getattr(estimate, f"confidence_{name}") >= CONFIDENT:
            continue
        doubt, why = float(getattr(estimate, f"sd_{name}")) / value, []
        if data == 0:
            found[name] = f"not observed: this is the start value; {_NEEDS[name]}"
            continue
        if doubt > DOUBT:
            why.append(f"one standard deviation is {100.0 * doubt:.0f} %")
        if contradict and name != "r":
            why.append("mu_s was not above mu_c, so both are their mean")
        if misfit > MISFIT and name != "mu_s":
            why.append(f"the residuals are {misfit**0.5:.1f} times what noise explains")
        what = ", ".join(why) or f"little data ({data})"
        found[name] = f"{what}: be cautious; {_NEEDS[name]}"
    return found
