"""Reads the tugged grasps of magnetic pads, and asks whether the slip decision of the estimators finds tugs.

A record is 300 samples of two pads with five magnetometers of three axes each, in raw units, and one label:
tugged or not. There is no calibrated force, no slip velocity, no rate and no time of onset. A slip of the
estimators starts where a scaled speed exceeds eps_v; here the speed is that of the field, so the largest
speed of a record decides, and the area under the curve covers every eps_v. The excursion from the field at
rest is beside it, which is a load rather than a slip.

The records are zip files of PyTorch. Their numbers are read as bytes; the pickle in them is never loaded.
"""

from __future__ import annotations

import zipfile
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.signal import savgol_filter
from scipy.stats import rankdata

from lab.pushes.run import value_and_interval
from policies.data.fetch import read
from policies.data.sets import SETS

FOLDER = "slip_detection/data"
SHAPE = 300, 2, 15
"""Samples, pads, axes of a record."""
REST = 50
"""Samples at the beginning whose median is the field at rest, as the authors have it."""
WINDOW, ORDER = 11, 3
"""Of the authors' Savitzky-Golay filter."""
EXTRACT = Path(__file__).with_name("tugs.csv")
SCORES = {
    "speed_0": "speed, first pad",
    "speed_1": "speed, second pad",
    "excursion_0": "excursion, first pad",
    "excursion_1": "excursion, second pad",
}
"""Column of the extract -> what it is."""


def record(data: bytes) -> np.ndarray:
    """The field of a record, `SHAPE` [raw units].

    Raises:
        ValueError: The bytes are no such record.
    """
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            (numbers,) = (name for name in archive.namelist() if name.endswith("/data/0"))
            return np.frombuffer(archive.read(numbers), "<f4").reshape(SHAPE).astype(float)
    except (ValueError, zipfile.BadZipFile) as error:
        raise ValueError(f"not a record of {SHAPE} numbers: {error}") from error


def scores(field: np.ndarray) -> np.ndarray:
    """Largest speed and largest excursion of each pad, in the order of `SCORES` [raw units].

    Args:
        field: Of `record`.
    """
    smooth, speed = (np.array(savgol_filter(field, WINDOW, ORDER, deriv=k, axis=0)) for k in (0, 1))
    excursion = smooth - np.median(smooth[:REST], axis=0)
    return np.concatenate([np.linalg.norm(values, axis=2).max(axis=0) for values in (speed, excursion)])


def reduced(folder: Path) -> pd.DataFrame:
    """Label and scores of each record of the set in a folder.

    Raises:
        ValueError: A file is missing or another one.
    """
    tugs = SETS["tugs"]
    labels = [int(word) for word in read(tugs, folder, f"{FOLDER}/labels").split()]
    files = [f"{FOLDER}/seq_{number}.pt" for number in range(len(labels))]
    rows = np.array([scores(record(read(tugs, folder, file))) for file in files])
    return pd.DataFrame({"tugged": labels, **dict(zip(SCORES, rows.T, strict=True))})


def area(score: np.ndarray, tugged: np.ndarray) -> float:
    """Chance that a tugged record has the larger score, ties half [-]; NaN if one kind is absent."""
    yes, no = int(tugged.sum()), int((~tugged).sum())
    if yes == 0 or no == 0:
        return np.nan
    return float((rankdata(score)[tugged].sum() - 0.5 * yes * (yes + 1)) / (yes * no))


def areas(table: pd.DataFrame, number: int, seed: int) -> pd.DataFrame:
    """A row for each score: area with a 95 % interval of a bootstrap over records, and what is not separated.

    Args:
        table: Of `reduced`, or the extract.
        number: Of bootstrap resamples.
        seed: Of the resamples.
    """
    tugged = table["tugged"].to_numpy(bool)
    drawn = np.random.default_rng(seed).integers(0, len(tugged), (number, len(tugged)))
    rows = []
    for column, meaning in SCORES.items():
        score = table[column].to_numpy(float)
        again = [area(score[index], tugged[index]) for index in drawn]
        found = np.array([area(score, tugged), *(value for value in again if np.isfinite(value))])
        above = int((score[~tugged] > score[tugged].min()).sum())
        rows.append((meaning, value_and_interval(found, 2), f"{above} of {int((~tugged).sum())}"))
    return pd.DataFrame(rows, columns=["score", "area", "not tugged, above the lowest tugged"])
