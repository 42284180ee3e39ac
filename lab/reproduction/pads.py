"""Repeats the paper's planar trials on other pads, to test what may explain its large contact radius."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import joblib
import numpy as np
import pandas as pd
import yaml
from tqdm import tqdm

from lab.frames import among
from lab.reproduction.mechanism import truly_sliding
from lab.reproduction.planar import record_planar, scenarios
from lab.reproduction.records import Record
from lab.reproduction.rerun import QUANTITIES, estimates, variants
from lab.reproduction.tables import grid
from policies.evaluation.folder import stamped
from policies.evaluation.frames import distinct, values, where
from policies.versions import write_versions
from slipgym.atomic_io import new_folder
from slipgym.config import load_randomization
from slipgym.config.pad import EFFECTS

PRESET = "lab"
"""Randomization whose pads are drawn."""
SHIFT = ("cop_lever", "cop_offset")
"""Its fields that shift the centre of pressure."""
SOFT = tuple(name for name in EFFECTS if name not in SHIFT)
"""Its fields that make a pad one of rubber."""


class Pads(NamedTuple):
    """What holds for both pads in all trials."""

    contact: str = "distributed"
    """Friction model."""
    pressure: str = "uniform"
    """Pressure profile; r is the one that it has on the whole pad."""
    soft: bool = False
    """Whether the fields `SOFT` are drawn for each trial."""
    shifted: bool = False
    """Whether the fields `SHIFT` are."""


PADS = {
    "ellipsoid": Pads("ellipsoid"),
    "uniform disc": Pads(),
    "Hertz": Pads(pressure="hertz"),
    "rim": Pads(pressure="rim"),
    "soft": Pads(soft=True),
    "shifted": Pads(shifted=True),
    "Hertz, soft, shifted": Pads(pressure="hertz", soft=True, shifted=True),
}
"""Name in the tables -> pads; where the centre of pressure is shifted, there is a row more."""
NOT_MEASURED = "{}, read at the pad's centre"
"""Name of that row: the estimators take the pad's centre for the centre of pressure."""


def reproduce_planar_pads(
    output: str | os.PathLike[str] = "runs",
    trials: int = 10,
    jobs: int = 1,
    seed: int = 0,
    progress: bool = True,
) -> Path:
    """Records the planar trials on each of `PADS` and runs every estimator on the records.

    Args:
        output: Folder that the run's own folder goes to.
        trials: Per material and pads; the objects and turns are the same for all pads.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        seed: Of the experiment.
        progress: Whether to show progress bars.

    Returns:
        The run's folder: trials.csv, table.md, settings.yaml, versions.json.

    Raises:
        ValueError: There are no trials.
    """
    cases = [(name, scenario) for name in PADS for scenario in scenarios(trials, seed)]
    parallel = joblib.Parallel(n_jobs=jobs, return_as="generator")
    found: Any = parallel(joblib.delayed(_trial)(*case) for case in cases)
    listed = tqdm(found, total=len(cases), desc="pads", unit="trial", disable=not progress)
    table = pd.DataFrame([row for trial in listed for row in trial])
    settings = {"trials": trials, "seed": seed, "preset": PRESET}
    path = stamped(output, f"planar_pads__{seed}")
    with new_folder(path) as folder:
        write_versions(folder)
        table.to_csv(folder / "trials.csv", index=False)
        pads = {name: each._asdict() for name, each in PADS.items()}
        text = yaml.safe_dump({**settings, "pads": pads}, sort_keys=False)
        (folder / "settings.yaml").write_text(text, encoding="utf-8")
        (folder / "table.md").write_text(_page(table) + "\n", encoding="utf-8")
    return path


def overrides(pads: Pads, seed: int) -> dict[str, Any]:
    """Configuration of a trial.

    Args:
        pads: Its pads.
        seed: The trial's; what is drawn for pads does not depend on which of it they use.
    """
    ranges, rng = load_randomization(PRESET), np.random.default_rng([seed, 1])

    def draw(name: str) -> float:
        return getattr(ranges, name).at(rng.random())

    drawn = {name: draw(name) for name in (*SOFT, "cop_lever")}
    offset = [[draw("cop_offset") for _ in range(2)] for _ in range(2)]
    chosen = (*(SOFT if pads.soft else ()), *(SHIFT if pads.shifted else ()))
    contact = {"pressure": pads.pressure, "pad": {name: drawn[name] for name in chosen if name in drawn}}
    return {"contact": contact | ({"cop_offset": offset} if pads.shifted else {})}


def at_the_centre(record: Record) -> Record:
    """The record as a gripper has it that takes the pad's centre for the centre of pressure."""
    wrenches, twists = record.wrenches.copy(), record.twists.copy()
    c_x, c_y = np.moveaxis(record.centres, -1, 0)
    wrenches[..., 3] += c_x * wrenches[..., 1] - c_y * wrenches[..., 0]
    twists[..., 0] += twists[..., 2] * c_y
    twists[..., 1] -= twists[..., 2] * c_x
    return replace(record, wrenches=wrenches, twists=twists)


def rows(name: str, record: Record) -> Iterator[dict[str, Any]]:
    """What each estimator says of a trial: a row for each quantity, NaN where it learnt nothing.

    Args:
        name: Of the pads.
        record: The trial; its friction may depend on time, so that every sample has a truth of its own.
    """
    slides = truly_sliding(record)
    for variant in variants():
        found = estimates(record, variant)
        for quantity, count in QUANTITIES.items():
            true = record.friction[:, ("mu_s", "mu_c", "r").index(quantity)]
            learnt = [slides & (found[count][:, finger] > 0) for finger in range(2)]
            ratios = [found[quantity][at, f] / true[at] for f, at in enumerate(learnt) if at.any()]
            means = [found[quantity][at, f] for f, at in enumerate(learnt) if at.any()]
            yield {
                "pads": name,
                "material": record.keys["material"],
                "trial": record.keys["trial"],
                "estimator": variant.title,
                "quantity": quantity,
                "true": true[slides].mean() if slides.any() else np.nan,
                "mean": np.mean([each.mean() for each in means]) if means else np.nan,
                "error": np.mean([each.mean() for each in ratios]) - 1.0 if ratios else np.nan,
                "dropped": record.dropped,
            }


def _trial(name: str, scenario: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Records one trial and runs the estimators on it."""
    pads = PADS[name]
    record = record_planar(scenario, pads.contact, overrides(pads, scenario["seed"]))
    found = list(rows(name, record))
    if pads.shifted:
        found += rows(NOT_MEASURED.format(name), at_the_centre(record))
    return found


def _page(table: pd.DataFrame) -> str:
    """The tables: errors of r and mu_c, and r itself, a row for each of the pads."""
    first = where(table, estimator=distinct(table, "estimator")[0], quantity="r")
    recorded = among(first, "pads", PADS)
    dropped = values(recorded, "dropped").sum()
    head = f"# planar, pads: {len(recorded) // len(PADS)} trials on each, {dropped} dropped"
    parts = [head, "Mean over the trials ± their standard deviation."]
    for quantity, column, title, scale, form in (
        ("r", "error", "Error of r [%]", 100.0, "{:+.1f}"),
        ("mu_c", "error", "Error of mu_c [%]", 100.0, "{:+.1f}"),
        ("r", "mean", "r [mm]", 1e3, "{:.1f}"),
    ):
        own = where(table, quantity=quantity)
        truths = [("true", "true", where(own, estimator=distinct(own, "estimator")[0]))]
        columns = truths if column == "mean" else []
        columns += [(each, column, where(own, estimator=each)) for each in distinct(own, "estimator")]
        lines = [
            [pads, *(_cell(scale * values(where(part, pads=pads), name), form) for _, name, part in columns)]
            for pads in distinct(own, "pads")
        ]
        parts += [f"## {title}", grid(["pads", *(heading for heading, *_ in columns)], lines)]
    return "\n\n".join(parts)


def _cell(numbers: np.ndarray, form: str) -> str:
    """Mean and standard deviation of those that are there; a dash for none."""
    there = numbers[~np.isnan(numbers)]
    if not len(there):
        return "–"
    spread = f" ± {there.std(ddof=1):.1f}" if len(there) > 1 else ""
    return form.format(there.mean()).replace("-", "−") + spread
