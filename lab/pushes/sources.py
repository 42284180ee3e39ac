"""Finds the repository of pushes and its logs, and checks their digests."""

from __future__ import annotations

from typing import NamedTuple

from policies.data.sets import SETS

REPOSITORY = SETS["pushes"].url.removeprefix("https://")
COMMIT = SETS["pushes"].commit
FOLDER = "PushExp/sensor_log"
"""Folder of the logs in the repository."""


class Log(NamedTuple):
    """A log of the repository."""

    path: str
    """File below `FOLDER`."""
    sha256: str
    """Digest of the file, or its first digits."""


def _logs(paths: dict[str, str]) -> dict[str, Log]:
    known = SETS["pushes"].files
    return {name: Log(path, known[f"{FOLDER}/{path}"].sha256) for name, path in paths.items()}


LOGS = _logs(
    {
        "board, large": "10_130_10_10_10_130/exp_08_17_50.txt",
        "board, wide": "10_90_10_10_30_130/exp_08_15_50.txt",
        "board, small": "30_90_30_30_30_90/exp_08_11_50_mixed.txt",
        "board, tiny": "30_63.33_43.33_30_43.33_63.33/exp_08_17_50.txt",
        "board, patch": "patch/exp_08_18_1435_50.txt",
        "wood, large": "wood_10_130_10_10_10_130/exp_08_17_50.txt",
        "wood, wide": "wood_10_90_10_10_30_130/exp_08_18_1100_50.txt",
        "wood, small": "wood_30_90_30_30_30_90/exp_08_17_0922_50.txt",
        "wood, tiny": "wood_30_63.33_43.33_30_43.33_63.33/exp_08_18_1330_50.txt",
        "wood, patch": "wood_patch/exp_08_17_0839_50.txt",
    }
)
"""Name, "surface, support" -> log. 50 pushes each."""
HELD_OUT = _logs(
    {
        "board, wide, exp_08_11_20": "10_90_10_10_30_130/exp_08_11_20.txt",
        "board, wide, exp_08_11_30": "10_90_10_10_30_130/exp_08_11_30.txt",
        "board, small, exp0": "30_90_30_30_30_90/exp0.txt",
        "board, small, exp08_11_20": "30_90_30_30_30_90/exp08_11_20.txt",
        "board, small, exp1": "30_90_30_30_30_90/exp1.txt",
        "board, small, exp10_15": "30_90_30_30_30_90/exp10_15.txt",
        "board, small, exp2_20": "30_90_30_30_30_90/exp2_20.txt",
        "board, small, exp2_30": "30_90_30_30_30_90/exp2_30.txt",
        "board, small, exp3_30": "30_90_30_30_30_90/exp3_30.txt",
        "board, small, exp4_10": "30_90_30_30_30_90/exp4_10.txt",
        "board, small, exp4_10_2": "30_90_30_30_30_90/exp4_10_2.txt",
        "board, small, exp5_15": "30_90_30_30_30_90/exp5_15.txt",
        "board, small, exp6_5": "30_90_30_30_30_90/exp6_5.txt",
        "board, small, exp7_20": "30_90_30_30_30_90/exp7_20.txt",
        "board, small, exp8_35_mixed": "30_90_30_30_30_90/exp8_35_mixed.txt",
        "board, small, exp9_15": "30_90_30_30_30_90/exp9_15.txt",
        "board, small, exp9_20": "30_90_30_30_30_90/exp9_20.txt",
        "board, small, exp_08_11_30": "30_90_30_30_30_90/exp_08_11_30.txt",
    }
)
"""The smaller logs of the same supports, of which nothing in this project was fixed."""
