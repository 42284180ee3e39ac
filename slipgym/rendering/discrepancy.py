"""Says in words why the estimated friction differs from the true friction, for pictures and the viewer."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from estimator.estimate import Estimate
from estimator.reasons import NEEDS, causes, doubts
from slipgym.rendering.history import History

if TYPE_CHECKING:
    from slipgym.envs.simulation import Simulation

VISIBLE = 0.02
"""Error over the true value from which it is seen in a picture, and named."""
LARGE = 0.1
"""Error over the true value from which it is named even within the stated deviation."""
RECENT = 0.5
"""Time within which data are new and a change of friction is recent [s]."""


class Discrepancy(NamedTuple):
    """A friction coefficient whose estimate is off, or that has none; both, if the words are the same."""

    name: str
    """"mu_c", "mu_s" or "mu_c, mu_s"."""
    error: str
    """Its error in words, and the deviation that the estimator states."""
    reason: str
    """Why."""


def discrepancies(simulation: Simulation, row: int, history: History) -> list[Discrepancy]:
    """Estimates of an environment that are off, or have no data; none if there are no estimators.

    An estimate is off if it differs from the truth by more than its stated standard deviation, or by
    more than `LARGE`. The reasons are those of the estimator (`estimator.reasons`), how old its newest data
    are, and what it does not know: whether the true friction has changed since.
    """
    found: list[Discrepancy] = []
    if not hasattr(simulation, "estimator"):
        return found
    for k, name in ((1, "mu_c"), (0, "mu_s")):
        value, confidence, deviation = simulation.estimated[row, [k, 3 + k, 6 + k]].tolist()
        true = float(simulation.ground_truth[row, k])
        error = value - true
        if not confidence:
            found.append(Discrepancy(name, "not observed", NEEDS[name]))
        elif abs(error) > max(min(deviation, LARGE * true), VISIBLE * true):
            size = f"{100.0 * abs(error) / true:.0f} % {'above' if error > 0.0 else 'below'} the truth"
            states = f"; states ± {100.0 * deviation / true:.0f} %" if deviation else ""
            within = abs(error) <= deviation
            found.append(Discrepancy(name, size + states, _reason(simulation, row, history, name, within)))
    if len(found) == 2 and found[0][1:] == found[1][1:]:
        return [found[0]._replace(name="mu_c, mu_s")]
    return found


def _reason(simulation: Simulation, row: int, history: History, name: str, within: bool) -> str:
    """Why an estimate with data is off, or that it is `within` its deviation: the first that applies."""
    true = history.column(f"true_{name}")
    errors = np.abs(history.column(name) / true - 1.0)
    newest = _last_change(history, f"data_{name}", 0.0)
    age = (history.step - newest) * history.step_time
    if min(abs(true[-1] / true[newest] - 1.0), errors[-1] - errors[newest]) > VISIBLE:
        return f"friction changed; newest data {age:.1f} s old"
    if found := _causes(simulation, row, name):
        return found[0]
    if within:
        return "no more than it states"
    if age >= RECENT:
        return f"newest data {age:.1f} s old"
    changed = (history.step - _last_change(history, f"true_{name}", 0.5 * errors[-1])) * history.step_time
    if changed < min(RECENT, history.time):
        return f"friction changed {changed:.1f} s ago"
    return "more than it states: errors of sensors or model"


def _causes(simulation: Simulation, row: int, name: str) -> tuple[str, ...]:
    """The causes but the deviation, which is named already; of the finger with more confidence."""
    batch = simulation.estimator
    fingers = range(2 * row, 2 * row + 2)
    best = max(fingers, key=lambda finger: batch.estimates[f"confidence_{name}"][finger])
    estimate = Estimate._make(batch.estimates[best].item())._replace(sd_mu_s=0.0, sd_mu_c=0.0)
    return causes(estimate, *doubts(batch.states[best])[:2])[name]


def _last_change(history: History, column: str, change: float) -> int:
    """Step since which a column is at its present value, up to a fraction of it; 0 if always."""
    values = history.column(column)
    other = np.flatnonzero(np.abs(values - values[-1]) > change * abs(values[-1]))
    return int(other[-1]) + 1 if len(other) else 0
