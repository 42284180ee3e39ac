"""Summarises a run: final values, warnings, what was not observable, facts about the record."""

from __future__ import annotations

from typing import Any

import numpy as np

from estimator.estimate import Estimate
from estimator.reasons import COUNTS, Doubts, reasons
from estimator.records.alignment import Samples, period
from estimator.records.calibration import calibration_rows
from estimator.records.faults import ENOUGH, fault_warnings, slides
from estimator.records.reading import CONTACT
from estimator.records.readings import reading_warnings
from estimator.records.record import Record
from estimator.records.run import Result

_NAMES = ("mu_s", "mu_c", "r")
FRICTION = (0.05, 3.0)
"""Plausible friction coefficients [-], from lubricated steel to silicone rubber on glass."""
RADIUS = (0.001, 0.05)
"""Plausible radii of the equivalent rim contact of a fingertip or pad [m]."""


def report(result: Result) -> str:
    """The summary for a terminal: final values with confidence, warnings, and what was not observable."""
    lines = [*_aligned(final_rows(result)), "", *findings(result)]
    if result.calibration is not None:
        lines += ["", *_aligned(_sensors(result))]
    return "\n".join(lines)


def markdown(result: Result) -> str:
    """The summary as a Markdown page."""
    settings = ", ".join(f"{name} = {value}" for name, value in result.given.items())
    sensors: list[str] = []
    if result.calibration is not None:
        sensors = ["## What it found about the sensors", _table(_sensors(result))]
    parts = [
        f"# {result.record.name}",
        f"Estimator `{result.estimator}`; parameters: {settings or 'all at their defaults'}.",
        "## Final values",
        _table(final_rows(result)),
        "Confidence is 0 for an untouched start value and near 1 once data has replaced it.",
        "## Warnings, and what was not observable",
        "\n".join(f"- {line}" for line in findings(result)),
        *sensors,
        "## The record",
        "\n".join(["| | |", "| --- | ---: |", *map(_row, record_facts(result))]),
    ]
    return "\n\n".join(parts) + "\n"


def final_rows(result: Result) -> list[list[str]]:
    """A heading, then mu_s, mu_c, r as cells: value ± sd if data set it, confidence, data, truth if known."""
    last, truth = result.estimates[-1], result.samples.truth
    known = truth is not None and not np.isnan(truth[-1]).all()
    rows = [["", "final ± sd", "confidence", "data", *(["true", "error"] if known else [])]]
    for k, name in enumerate(_NAMES):
        scale, digits = (1e3, 2) if name == "r" else (1.0, 3)
        data = f"{last[COUNTS[name]]} {'events' if name == 'mu_s' else 'samples'}"
        value, sd = scale * float(last[name]), scale * float(last[f"sd_{name}"])
        cells = [
            "r [mm]" if name == "r" else name,
            f"{value:.{digits}f}" + (f" ± {sd:.{digits}f}" if last[COUNTS[name]] else ""),
            f"{last[f'confidence_{name}']:.2f}",
            data,
        ]
        if known and truth is not None:
            true = scale * float(truth[-1, k])
            compared = last[COUNTS[name]] > 0 and not np.isnan(true) and true != 0.0
            error = f"{100.0 * (value / true - 1.0):+.0f} %".replace("-", "−") if compared else "–"
            cells += ["–" if np.isnan(true) else f"{true:.{digits}f}", error]
        rows.append(cells)
    return rows


def findings(result: Result) -> list[str]:
    """Warnings, then a line for each value that was not observable; "Everything was observed" if none."""
    lines = [*faults(result.record, result.samples), *warnings(result), *not_observable(result)]
    return lines or ["Everything was observed."]


def faults(record: Record, samples: Samples) -> list[str]:
    """Warnings about the readings alone, whatever an estimator makes of them."""
    return [*reading_warnings(record, samples), *fault_warnings(record, samples)]


def warnings(result: Result) -> list[str]:
    """A line for each final value that was estimated from data and is not plausible for a fingertip.

    Friction coefficients are expected within 0.05 to 3, mu_s above mu_c, and r within 1 to 50 mm and between
    the bounds `r_min` and `r_max` of the estimator, where it has them.
    """
    last, lines = result.estimates[-1], []
    seen = {name: float(last[name]) for name in ("mu_s", "mu_c", "r") if last[f"confidence_{name}"] > 0.0}
    for name in ("mu_s", "mu_c"):
        if name in seen and not FRICTION[0] <= seen[name] <= FRICTION[1]:
            lines.append(
                f"Warning: {name} = {seen[name]:.3g} is implausible, outside {FRICTION[0]:g} to "
                f"{FRICTION[1]:g}: check units and columns, or use another estimator."
            )
    if "mu_s" in seen and seen["mu_s"] <= last["mu_c"]:
        lines.append(
            f"Warning: mu_s is not above mu_c = {last['mu_c']:.3g}: the stick-slip events show no more than "
            "Coulomb friction. Do not rely on mu_s."
        )
    if "r" in seen:
        lines += _radius_warnings(result, seen["r"])
    lines += [
        f"Warning: sigma_2 = {error.value:.3g} s/m: friction falls as the speed rises, which is no "
        "viscosity: check the signs of the velocities and the zeros of the forces."
        for error in (() if result.calibration is None else result.calibration.errors)
        if error.name == "sigma_2" and error.seen and error.value < -2.0 * error.sd
    ]
    return lines


def _radius_warnings(result: Result, r: float) -> list[str]:
    what = f"Warning: r = {1e3 * r:.3g} mm"
    smallest, largest = (getattr(result.parameters, name, None) for name in ("r_min", "r_max"))
    if largest is not None and r >= largest:
        return [f"{what} is at its upper bound r_max: is the pad larger, or is the CoP wrong?"]
    if smallest is not None and r <= smallest:
        return [f"{what} is at its lower bound r_min: check omega and tau."]
    if not RADIUS[0] <= r <= RADIUS[1]:
        return [
            f"{what} is implausible, outside {1e3 * RADIUS[0]:g} to {1e3 * RADIUS[1]:g} mm: "
            "check units and columns, or use another estimator."
        ]
    return []


def not_observable(result: Result) -> list[str]:
    """A line for each value about which the record holds little or no information."""
    if not (result.samples.wrench[:, 2] >= CONTACT).any():
        return [f"f_n never reaches {CONTACT} N: there was no contact."]
    against = Doubts() if result.calibration is None else result.calibration.doubts
    found = reasons(Estimate._make(result.estimates[-1].item()), *against)
    f_n = result.samples.wrench[slides(result.samples), 2]
    if "mu_c" in found and not result.estimates[-1][COUNTS["mu_c"]] and len(f_n) >= ENOUGH:
        found["mu_c"] = (
            f"not observed: this is the start value, although {len(f_n)} samples slip: f_n is below "
            f"{CONTACT} N in {_percent(f_n < CONTACT)} of them, the others show no friction to rely on"
        )
    lines = [f"{name}: {why}." for name, why in found.items()]
    if result.samples.segment[-1] > 0:
        lines.append(
            "The estimator starts afresh after a gap: the final values come from what follows the last gap."
        )
    return lines


def record_facts(result: Result) -> list[list[str]]:
    """Facts about the record, as pairs of cells."""
    record, samples, estimates = result.record, result.samples, result.estimates
    halted = estimates["halted"]
    ends = np.append(np.flatnonzero(np.diff(samples.segment)), len(estimates) - 1)
    halts = np.count_nonzero(np.diff(halted.astype(int), prepend=0) == 1)
    contact = samples.wrench[:, 2] >= CONTACT
    pressed = f"{np.median(samples.wrench[contact, 2]):.2f} N" if contact.any() else "–"
    facts: list[tuple[str, Any]] = [
        ("duration", f"{samples.t[-1] - samples.t[0]:.2f} s"),
        ("force samples", f"{len(record.force_t)} at {1.0 / period(record.force_t):.0f} Hz"),
        ("velocity samples", f"{len(record.twist_t)} at {1.0 / period(record.twist_t):.0f} Hz"),
        ("velocity samples without a new enough force", samples.left_out),
        ("gaps", samples.segment[-1]),
        ("centre of pressure", "the origin" if record.cop is None else "from the record"),
        ("in contact", _percent(contact)),
        ("slipping", _percent(estimates["slipping"])),
        ("normal force in contact, median", pressed),
        ("slip speed, largest", f"{1e3 * np.hypot(*samples.twist[:, :2].T).max():.1f} mm/s"),
        ("stick-slip events that set mu_s", estimates["events_mu_s"][ends].sum()),
        ("halts by the heuristic", f"{halts}, {_percent(halted)} of the samples"),
    ]
    return [[name, str(value)] for name, value in facts]


def _sensors(result: Result) -> list[list[str]]:
    assert result.calibration is not None
    return calibration_rows(result.calibration, period(result.record.twist_t))


def _aligned(rows: list[list[str]]) -> list[str]:
    """Lines of a table for a terminal, with a rule below the heading."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]
    return [lines[0], "-" * len(lines[0]), *(line.rstrip() for line in lines[1:])]


def _table(rows: list[list[str]]) -> str:
    """A table as Markdown."""
    return "\n".join([_row(rows[0]), "| --- |" + " ---: |" * (len(rows[0]) - 1), *map(_row, rows[1:])])


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _percent(flags: np.ndarray) -> str:
    return f"{100.0 * flags.mean():.0f} %"
