"""Writes the files of a run."""

from __future__ import annotations

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
