"""The paper's simulation: a uniform disc under a velocity profile, estimated."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pandas as pd
from tqdm import tqdm

import estimator
from lab.reproduction.fixed_point import disc_bias
from lab.reproduction.profile_page import page
from lab.reproduction.profile_plot import plot_profile
from policies.evaluation.plots.style import STYLE, styled
from policies.leaderboard.profile_course import STEADY, STOP, profile
from policies.leaderboard.scenario import replay
from policies.versions import stamped, write_versions
from slipgym.atomic_io import new_folder
from slipgym.contact import DistributedContact
from slipgym.synthetic import Record, Trace, ideal, integrate, sense

SIGMA_2 = 0.2  # viscous friction per normal force [s/m]
CELLS = 41  # of the patch, along either side; 21 put planar errors off by up to 0.7 points
LATENCY = {"ideal": 0, "realistic": 1}  # of a velocity [samples]


def reproduce_profile(
    output: str | os.PathLike[str] = "runs", seeds: int = 20, seed: int = 0, progress: bool = True
) -> Path:
    """Runs every estimator on the velocity profile, with exact data and with realistic sensors.

    Args:
        output: Folder that the run's own folder goes to.
        seeds: Records with noise of their own.
        seed: Of the noise.
        progress: Whether to show progress bars.

    Returns:
        The run's folder: series.csv (of the first record), phases.csv, events.csv, table.md with both,
        ideal.png, realistic.png.
    """
    trace = integrate(profile(), DistributedContact(cells=CELLS, sigma_2=SIGMA_2))
    records = {"ideal": ideal(trace, instant=True), "realistic": sense(trace, seeds, seed)}
    jobs = [(sensors, name) for sensors in records for name in estimator.names()]
    found = {
        job: replay(job[1], records[job[0]], LATENCY[job[0]])
        for job in tqdm(jobs, desc="estimators", unit="run", disable=not progress)
    }
    expected = predicted(trace)
    tables = {
        "phases": pd.concat(phases(trace, expected, *job, estimates) for job, estimates in found.items()),
        "events": pd.concat(events(trace, *job, estimates) for job, estimates in found.items()),
    }
    path = stamped(output, "profile")
    with new_folder(path) as folder:
        write_versions(folder)
        series(records, found).to_csv(folder / "series.csv", index=False)
        for name, table in tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
        (folder / "table.md").write_text(page(**tables), encoding="utf-8")
        with styled():
            for sensors in records:
                shown = {name: found[sensors, name][0] for name in estimator.names()}
                plot_profile(trace, shown, expected).savefig(folder / f"{sensors}.png", dpi=STYLE.dpi)
    return path


def gamma_t(trace: Trace) -> np.ndarray:
    """Share of translation at the true r, (n,) [-]; NaN at rest."""
    v_t, v_r = np.hypot(*trace.twist[:, :2].T), trace.r * np.abs(trace.twist[:, 2])
    speed = np.hypot(v_t, v_r)
    return np.divide(v_t, speed, out=np.full_like(speed, np.nan), where=speed > 0.0)


def predicted(trace: Trace) -> np.ndarray:
    """Relative errors of mu_c and r that the ellipsoid makes on this disc, (n, 2) [-].

    NaN where the slip does not show the quantity: r in translation, both in spin and at rest.
    """
    bias = np.full((len(trace.t), 2), np.nan)
    speeds = np.hypot(np.hypot(*trace.twist[:, :2].T), trace.r * trace.twist[:, 2])
    for k, share in enumerate(gamma_t(trace)):
        viscous = SIGMA_2 * speeds[k] / trace.mu_c[k]
        if share == 1.0:
            bias[k, 0] = viscous
        elif share > 0.0:
            bias[k] = disc_bias(share, viscous)
    return bias


def phases(
    trace: Trace, expected: np.ndarray, sensors: str, name: str, estimates: np.ndarray
) -> pd.DataFrame:
    """Errors of mu_c and r at the end of each steady phase, beside what the ellipsoid predicts [%]."""
    rows = []
    for label in STEADY:
        at = int(np.flatnonzero(trace.phase == label)[-1])
        row = {"sensors": sensors, "estimator": name, "phase": label, "gamma_t": gamma_t(trace)[at]}
        for column, field in enumerate(("mu_c", "r")):
            error = 100.0 * (estimates[field][:, at] / getattr(trace, field)[at] - 1.0)
            row |= {f"{field}_%": error.mean(), f"{field}_sd_%": error.std()}
            row[f"{field}_predicted_%"] = 100.0 * expected[at, column]
        rows.append(row)
    return pd.DataFrame(rows)


def events(trace: Trace, sensors: str, name: str, estimates: np.ndarray) -> pd.DataFrame:
    """Error of mu_s after each start and stop of slip, just before the next [%]."""
    stopped = trace.phase == STOP
    changes = np.flatnonzero(stopped[1:] != stopped[:-1]) + 1
    rows = []
    for at, following in zip(changes, [*changes[1:], len(trace.t)], strict=True):
        kind, label = ("stop of", trace.phase[at - 1]) if stopped[at] else ("start of", trace.phase[at])
        error = 100.0 * (estimates["mu_s"][:, following - 1] / trace.mu_s[at] - 1.0)
        event = {"event": f"{kind} {label}", "t_s": trace.t[at], "mu_s": trace.mu_s[at]}
        rows.append(
            {"sensors": sensors, "estimator": name, **event, "error_%": error.mean(), "sd_%": error.std()}
        )
    return pd.DataFrame(rows)


def series(records: dict[str, Record], found: dict[tuple[str, str], np.ndarray]) -> pd.DataFrame:
    """What the sensors said and what each estimator made of it, of the first records."""
    frames = []
    for (sensors, name), estimates in found.items():
        record = records[sensors]
        wrench, twist = record.wrenches[0].T, record.twists[0].T
        columns = {"t": record.t, **dict(zip(("f_x", "f_y", "f_n", "tau"), wrench, strict=True))}
        columns |= dict(zip(("v_x", "v_y", "omega"), twist, strict=True))
        for field in ("mu_s", "mu_c", "r"):
            columns |= {f"true_{field}": getattr(record, field), field: estimates[field][0]}
            columns[f"sd_{field}"] = estimates[f"sd_{field}"][0]
        frames.append(pd.DataFrame({"sensors": sensors, "estimator": name, "phase": record.phase, **columns}))
    return pd.concat(frames)
