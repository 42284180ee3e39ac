"""Parses the settings of a run, names its folder and writes its files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.online import TWIST, WRENCH
from estimator.records.extras import extra
from estimator.records.plot import plot
from estimator.records.run import Result
from estimator.records.summary import markdown
from estimator.records.units import TRUTH


def parse_settings(settings: Sequence[str], flag: str = "--set") -> dict[str, Any]:
    """Reads `name=value` pairs; a value is what YAML takes it for, and 1e-3 is a number.

    Args:
        settings: Such as ["heuristic=false", "eps_v=1e-3"].
        flag: The option of the command line they were given by, for the message of an error.

    Raises:
        ValueError: One has no "=", or its value is no YAML.
    """
    values = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        source = f"{flag} {setting!r}"
        if not equals or not name.strip():
            raise ValueError(f"{source}: must be name=value")
        try:
            value = extra("estimator.plain_files").parse(text, source)
        except ValueError as error:
            raise ValueError(f"{source}: the value cannot be read") from error
        if isinstance(value, str):
            with suppress(ValueError):
                value = float(value)
        values[name.strip()] = value
    return values


def run_name(log: str | os.PathLike[str]) -> str:
    """Name for the folder of a run that starts now: <record>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return f"{Path(log).name.partition('.')[0]}__{stamp}"


def write(result: Result, folder: Path) -> None:
    """Writes estimates.csv, summary.md, estimates.png and, where pyarrow is installed, estimates.parquet.

    Args:
        result: From `estimate`.
        folder: Where they go; it exists.

    Raises:
        ModuleNotFoundError: The extra `slipgym[cli]` is not installed.
        OSError: A file cannot be written.
    """
    frame = extra("pandas").DataFrame(table(result), copy=False)
    if find_spec("pyarrow") is not None:
        frame.to_parquet(folder / "estimates.parquet", index=False)
    frame.to_csv(folder / "estimates.csv", index=False, float_format="%.9g")
    (folder / "summary.md").write_text(markdown(result), encoding="utf-8")
    plot(result).savefig(folder / "estimates.png", dpi=150)


def table(result: Result) -> dict[str, NDArray[Any]]:
    """Columns with a row for each velocity sample: inputs and outputs of the estimator, ground truth."""
    samples, estimates = result.samples, result.estimates
    columns: dict[str, NDArray[Any]] = {"t": samples.t, "segment": samples.segment}
    columns |= {name: samples.wrench[:, k] for k, name in enumerate(WRENCH)}
    columns |= {name: samples.twist[:, k] for k, name in enumerate(TWIST)}
    columns |= {name: np.ascontiguousarray(estimates[name]) for name in estimates.dtype.names or ()}
    if samples.truth is not None:
        columns |= {name: samples.truth[:, k] for k, name in enumerate(TRUTH)}
    return columns
