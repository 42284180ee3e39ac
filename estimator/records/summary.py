"""Summarises a run: final values, warnings, what was not observable, facts about the record."""

from __future__ import annotations

from typing import Any

import numpy as np

from estimator.estimate import Estimate
from estimator.reasons import COUNTS, Doubts, reasons
from estimator.records.alignment import Samples, period
from estimator.records.calibration import calibration_rows
from estimator.records.faults import fault_warnings
from estimator.records.plausibility import warnings
from estimator.records.reading import CONTACT
from estimator.records.readings import reading_warnings
from estimator.records.record import Record
from estimator.records.run import Result
from estimator.records.signs import sign_warnings

_NAMES = ("mu_s", "mu_c", "r")


def report(result: Result) -> str:
    """The summary for a terminal: final values with confidence, warnings, and what was not observable."""
    lines = [*_aligned(final_rows(result)), "", *findings(result)]
    if result.calibration is not None:
        lines += ["", *_aligned(_sensors(result))]
    return "\n".join(lines)


def markdown(result: Result) -> str:
    """The summary as a Markdown page."""
    heading, *rows = final_rows(result)
    facts = record_facts(result)
    settings = (
        ", ".join(f"{name} = {value}" for name, value in result.given.items()) or "all at their defaults"
    )
    sensors: list[str] = []
    if result.calibration is not None:
        sensors = ["## What it found about the sensors", _table(_sensors(result))]
    parts = [
        f"# {result.record.name}",
        f"Estimator `{result.estimator}`; parameters: {settings}.",
        "## Final values",
        _table([heading, *rows]),
        "Confidence is 0 for an untouched start value and near 1 once data has replaced it.",
        "## Warnings, and what was not observable",
        "\n".join(f"- {line}" for line in findings(result)),
        *sensors,
        "## The record",
        "\n".join(["| | |", "| --- | ---: |", *(_row(fact) for fact in facts)]),
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
    return [*reading_warnings(record, samples), *fault_warnings(record, samples), *sign_warnings(samples)]


def not_observable(result: Result) -> list[str]:
    """A line for each value about which the record holds little or no information."""
    if not (result.samples.wrench[:, 2] >= CONTACT).any():
        return [f"f_n never reaches {CONTACT} N: there was no contact."]
    against = Doubts() if result.calibration is None else result.calibration.doubts
    found = reasons(Estimate._make(result.estimates[-1].item()), *against)
    lines = [f"{name}: {why}." for name, why in found.items()]
    if result.samples.segment[-1] > 0:
        lines.append(
            "The estimator starts afresh after a gap: the final values come from what follows the last gap."
        )
    return lines


def record_facts(result: Result) -> list[list[str]]:
    """Facts about the record, as pairs of cells."""
    record, samples, estimates = result.record, result.samples, result.estimates
    halted, slipping = estimates["halted"], estimates["slipping"]
    ends = np.append(np.flatnonzero(np.diff(samples.segment)), len(estimates) - 1)
    contact = samples.wrench[:, 2] >= CONTACT
    facts: list[tuple[str, Any]] = [
        ("duration", f"{samples.t[-1] - samples.t[0]:.2f} s"),
        ("force samples", f"{len(record.force_t)} at {1.0 / period(record.force_t):.0f} Hz"),
        ("velocity samples", f"{len(record.twist_t)} at {1.0 / period(record.twist_t):.0f} Hz"),
        ("velocity samples without a new enough force", samples.left_out),
        ("gaps", samples.segment[-1]),
        ("centre of pressure", "the origin" if record.cop is None else "from the record"),
        ("in contact", _percent(contact)),
        ("slipping", _percent(slipping)),
        (
            "normal force in contact, median",
            f"{np.median(samples.wrench[contact, 2]):.2f} N" if contact.any() else "–",
        ),
        ("slip speed, largest", f"{1e3 * np.hypot(*samples.twist[:, :2].T).max():.1f} mm/s"),
        ("stick-slip events that set mu_s", estimates["events_mu_s"][ends].sum()),
        ("halts by the heuristic", f"{_starts(halted)}, {_percent(halted)} of the samples"),
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


def _starts(flags: np.ndarray) -> int:
    return int(np.count_nonzero(np.diff(flags.astype(int), prepend=0) == 1))
