"""Reads and checks the log of a session on the bench."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from slipgym.identification.rollout import CHANNELS

COMMAND = "force"
MOTION = ("motion_x", "motion_y", "motion_omega")
COLUMNS = ("t", COMMAND, *MOTION, *CHANNELS)
"""Columns of a log: time [s], grip command [N], motion and readings in SI units."""
LEAST_NOISE = np.array([1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-5, 1e-4])
"""Of each reading, in its SI unit: no sensor is more exact, whatever a log shows."""
SHORTEST, LARGEST = 5.0, 1e4  # [s], in SI units
RATES = (20.0, 2000.0)  # [Hz]
ROWS_MAX = 200_000


@dataclass(frozen=True)
class Log:
    """A log of one finger on one clock, n rows in equal steps of time.

    Raises:
        ValueError: A shape, the rate, the length or a number is out of range.
    """

    rate: float
    """Rows per second [Hz]."""
    command: np.ndarray
    """Grip force commanded, (n,) [N]."""
    motion: np.ndarray
    """Twist of the object against the gripper, (n, 3) [m/s, m/s, rad/s]."""
    readings: np.ndarray
    """Wrench at the pad's centre and slip twist, (n, 7), see `CHANNELS`; NaN: that sensor is absent."""

    def __post_init__(self) -> None:
        n = len(self.command)
        shapes = (self.command.shape, self.motion.shape, self.readings.shape)
        if shapes != ((n,), (n, 3), (n, len(CHANNELS))):
            raise ValueError(
                f"command, motion and readings have shapes {shapes}; must be (n,), (n, 3), (n, 7)"
            )
        slip_absent = np.isnan(self.readings[:, 4:]).all()
        numbers = np.hstack([self.command[:, None], self.motion, self.readings[:, : 4 if slip_absent else 7]])
        if not np.isfinite(numbers).all():
            raise ValueError(
                "command, motion and readings must be finite; all three slip readings may be NaN"
            )
        if not RATES[0] <= self.rate <= RATES[1]:
            raise ValueError(f"{self.rate:g} rows per second; must be {RATES[0]:g} to {RATES[1]:g}")
        if n / self.rate < SHORTEST:
            raise ValueError(f"the log is {n / self.rate:.3g} s long; must be at least {SHORTEST:g} s")
        if (negative := self.command < 0.0).any():
            raise ValueError(f"row {int(np.argmax(negative)) + 1}: {COMMAND} must be >= 0 N")

    def noise(self) -> np.ndarray:
        """Standard deviation of each reading's white noise, whatever moves, (7,); NaN where it is absent.

        From the median of third differences, in which smooth motion vanishes, and the steps of the converter.
        """
        spread = 1.4826 * np.median(np.abs(np.diff(self.readings, 3, axis=0)), axis=0) / np.sqrt(20.0)
        steps = [np.diff(np.unique(each)).min(initial=np.inf) for each in self.readings.T]
        rounding = np.where(np.isfinite(steps), steps, 0.0) / np.sqrt(12.0)
        return np.maximum(np.maximum(spread, rounding), LEAST_NOISE)


def read_log(path: str | os.PathLike[str]) -> Log:
    """Reads a csv, csv.gz or parquet file with the columns `COLUMNS`; those of the slip twist may be absent.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A column is absent or not finite, or the time does not go on in equal steps; the message
            names file, column, row and range.
    """
    import pandas

    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    if not path.name.lower().endswith((".csv", ".csv.gz", ".parquet")):
        raise ValueError(f"{path.name}: unknown file type; a log is csv, csv.gz or parquet")
    try:
        frame = pandas.read_parquet(path) if path.suffix == ".parquet" else pandas.read_csv(path)
    except Exception as error:  # pandas and its engines have many
        raise ValueError(
            f"{path.name}: cannot be read as a table: {str(error).partition(chr(10))[0]}"
        ) from None
    slip = [name for name in CHANNELS[4:] if name in frame.columns]
    needed = COLUMNS if slip else COLUMNS[: -len(CHANNELS[4:])]
    if missing := [name for name in needed if name not in frame.columns]:
        raise ValueError(f"{path.name}: column {missing[0]} is missing; a log has {', '.join(needed)}")
    columns = [_numbers(path.name, name, frame[name]) for name in needed]
    rate = _rate(path.name, columns[0])
    n = len(columns[0])
    readings = np.full((n, len(CHANNELS)), np.nan)
    readings[:, : len(columns) - 5] = np.stack(columns[5:], axis=1)
    try:
        return Log(rate, columns[1], np.stack(columns[2:5], axis=1), readings)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None


def _numbers(file: str, name: str, column: object) -> np.ndarray:
    import pandas

    numbers: np.ndarray = pandas.to_numeric(column, errors="coerce").to_numpy(float)  # type: ignore[call-overload]
    bad = ~(np.abs(numbers) <= (np.inf if name == "t" else LARGEST)) | ~np.isfinite(numbers)
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(
            f"{file}: row {row + 1}: {name} must be a finite number of at most {LARGEST:g} in SI units"
        )
    return numbers


def _rate(file: str, t: np.ndarray) -> float:
    if not 2 <= len(t) <= ROWS_MAX:
        raise ValueError(f"{file}: has {len(t)} rows; a log has 2 to {ROWS_MAX}")
    step = (t[-1] - t[0]) / (len(t) - 1)
    off = np.abs(t - t[0] - step * np.arange(len(t))) > 0.5 * step
    if not step > 0.0 or off.any():
        row = int(np.argmax(off)) + 1
        raise ValueError(f"{file}: row {row}: t must rise in equal steps; resample onto one clock first")
    return float(1.0 / step)
