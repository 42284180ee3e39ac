"""The estimators on real pushes, beside a fit that knows the exact support: the tables of docs/pushes.md."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

import estimator
from lab.pushes.excess import REFERENCES, beyond_best, within_best
from lab.pushes.extract import Pushes
from lab.pushes.fit import fit, friction_of_each, harmonic, misfit
from lab.pushes.replay import replay
from lab.pushes.support import surface
from policies.evaluation.frames import markdown

PUBLISHED = {"board": 0.282, "wood": 0.336}
"""mu_c that the authors of the logs use; its origin is not stated."""
INTERVAL = (0.025, 0.975)
TINY = "tiny"
"""The support whose r is too small for the length of the pushes to be evaluated."""
QUANTITIES = ("mu_c", "r")


def entrants() -> dict[str, tuple[str, dict[str, object]]]:
    """Label -> name and parameters: every estimator, and "rls" with r0 in the block."""
    rows: dict[str, tuple[str, dict[str, object]]] = {name: (name, {}) for name in estimator.names()}
    rows["rls, r0 6 mm"] = "rls", {"r0": 0.006}
    return rows


def resamples(pushes: Pushes, number: int, seed: int) -> np.ndarray:
    """The pushes as logged and bootstrap resamples of them, (1 + number, n)."""
    n = len(pushes.values)
    drawn = np.random.default_rng(seed).integers(0, n, (number, n))
    return np.vstack((np.arange(n), drawn))


def references(logs: Iterable[Pushes], number: int, seed: int) -> pd.DataFrame:
    """The fits of each log, a row each; brackets hold bootstrap intervals of 95 %.

    Args:
        logs: Pushes of each log.
        number: Of bootstrap resamples.
        seed: Of the resamples.
    """
    rows = []
    for pushes in logs:
        found = fit(pushes, resamples(pushes, number, seed))
        r = surface(pushes.support).effective_radius
        rows.append(
            {
                "log": pushes.name,
                "positive work": "{} of {}".format(*dissipates([pushes])),
                "mu_c": value_and_interval(found.mu_c, 3),
                "mu_c, least squares": value_and_interval(found.mu_c_wrench, 3),
                "published": PUBLISHED.get(pushes.name.partition(",")[0], np.nan),
                "r [mm]": f"{1e3 * r:.1f}",
                "lengths, fitted": value_and_interval(found.scale, 2),
            }
        )
    return pd.DataFrame(rows)


def misfits(logs: Iterable[Pushes], number: int, seed: int) -> pd.DataFrame:
    """What the exact support does not explain, a row for each log.

    Args:
        logs: Pushes of each log.
        number: Of permutations for the thresholds of the harmonics.
        seed: Of the permutations.
    """
    rows = []
    for pushes in logs:
        chosen = np.arange(len(pushes.values))[None]
        found = misfit(pushes, float(fit(pushes, chosen).mu_c[0]))
        low, middle, high = 100.0 * np.quantile(found.residual, (0.1, 0.5, 0.9))
        row: dict[str, object] = {
            "log": pushes.name,
            "residual [%]": f"{middle:.0f} ({low:.0f}…{high:.0f})",
            "direction [°]": float(np.degrees(np.median(found.direction))),
            "mu_c of a push, sd [%]": 100.0 * float(found.spread.std(ddof=1)),
        }
        rng = np.random.default_rng(seed)
        for order, name in ((1, "once a turn [%]"), (2, "twice a turn [%]")):
            chance = [harmonic(rng.permutation(found.spread), found.heading, order) for _ in range(number)]
            seen = harmonic(found.spread, found.heading, order)
            row[name] = f"{100.0 * seen:.1f} ({100.0 * float(np.quantile(chance, 0.95)):.1f})"
        rows.append(row)
    return pd.DataFrame(rows)


def deviations(logs: Iterable[Pushes], number: int, seed: int) -> pd.DataFrame:
    """How far every entrant is from the fit (mu_c) and from geometry (r).

    Args:
        logs: Pushes of each log.
        number: Of bootstrap resamples; fit and estimator get the same.
        seed: Of the resamples.

    Returns:
        `log`, `support`, `estimator`, and for "mu_c", "mu_c_wrench" (from least squares), "r" and "r_fitted"
        (from geometry with the fitted lengths) the arrays (1 + number,) of deviations [%], first that of the
        log as it is.
    """
    rows = []
    for pushes in logs:
        chosen = resamples(pushes, number, seed)
        reference, r = fit(pushes, chosen), surface(pushes.support).effective_radius
        for label, (name, parameters) in entrants().items():
            found_mu_c, found_r = replay(name, pushes, chosen, **parameters)
            rows.append(
                {
                    "log": pushes.name,
                    "support": pushes.support,
                    "estimator": label,
                    "mu_c": 100.0 * (found_mu_c / reference.mu_c - 1.0),
                    "mu_c_wrench": 100.0 * (found_mu_c / reference.mu_c_wrench - 1.0),
                    "r": 100.0 * (found_r / r - 1.0),
                    "r_fitted": 100.0 * (found_r / (reference.scale * r) - 1.0),
                }
            )
    return pd.DataFrame(rows)


def by_log(found: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """A row for each log, a column for each entrant: deviation and interval [%]."""
    table: dict[str, dict[str, str]] = {}
    for row in found.to_dict("records"):
        cells = table.setdefault(row["log"], {"log": row["log"]})
        cells[row["estimator"]] = value_and_interval(row[quantity], 0)
    return pd.DataFrame(list(table.values()))


def worst(found: pd.DataFrame) -> pd.DataFrame:
    """The largest and the median size of an entrant's deviations [%], the smallest of mu_c first.

    r is that of all supports but the tiny ones, and that of three feet alone, since the pressure of the patch
    is not known.
    """
    rows = []
    for label in dict.fromkeys(found["estimator"]):
        own = [row for row in found.to_dict("records") if row["estimator"] == label]
        mu_c, least = (np.array([abs(float(row[key][0])) for row in own]) for key in ("mu_c", "mu_c_wrench"))
        r = {row["log"]: abs(float(row["r"][0])) for row in own if row["support"] != TINY}
        feet = [value for log, value in r.items() if not log.endswith("patch")]
        figures = mu_c.max(), np.median(mu_c), least.max(), max(r.values(), default=np.nan)
        rows.append((label, *map(float, figures), max(feet, default=np.nan)))
    columns = ["estimator", "mu_c, worst", "mu_c, median", "mu_c, worst from least squares", "r, worst"]
    table = pd.DataFrame(rows, columns=[*columns, "r, worst of three feet"])
    return table.sort_values(columns[1], ignore_index=True)


def value_and_interval(values: np.ndarray, digits: int) -> str:
    """The first value, and in brackets the interval of 95 % of the others."""
    figures = np.round([values[0], *np.quantile(values[1:], INTERVAL)], digits) + 0.0  # no negative zero
    value, low, high = (f"{figure:.{digits}f}".replace("-", "−") for figure in figures)
    return f"{value} [{low}, {high}]"


def dissipates(logs: Iterable[Pushes]) -> tuple[int, int]:
    """Number of pushes with positive friction work, and of all."""
    signs = np.concatenate([friction_of_each(pushes) > 0.0 for pushes in logs])
    return int(signs.sum()), len(signs)


def run_pushes(logs: list[Pushes], number: int = 400, seed: int = 0) -> str:
    """The tables, as Markdown.

    Args:
        logs: Pushes of each log.
        number: Of bootstrap resamples.
        seed: Of the resamples.
    """
    found = deviations(logs, number, seed)
    positive, all_of_them = dissipates(logs)
    parts = [
        f"{positive} of {all_of_them} pushes have positive friction work.",
        "## References",
        markdown(references(logs, number, seed), 3),
        "## What the exact support does not explain",
        markdown(misfits(logs, number, seed), 1),
    ]
    for quantity, against in zip(QUANTITIES, ("the fit", "geometry"), strict=True):
        parts += [f"## Deviation of {quantity} from {against} [%]", markdown(by_log(found, quantity))]
    parts += ["## Largest deviations [%]", markdown(worst(found), 1)]
    for quantity, meaning in REFERENCES.items():
        title = f"## Deviation of {meaning} beyond that of the best of four [percent points]"
        parts += [title, markdown(beyond_best(found, quantity))]
    parts += ["## Logs beyond the best of four", markdown(within_best(found), 1)]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"
