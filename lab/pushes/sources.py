"""Finds the repository of pushes and its logs, and checks their digests."""

from __future__ import annotations

from typing import NamedTuple

REPOSITORY = "github.com/robinzhoucmu/MLab_EXP"
COMMIT = "4d86db9438203f51c4368e5b886def5c402955f3"
FOLDER = "PushExp/sensor_log"
"""Folder of the logs in the repository."""


class Log(NamedTuple):
    """A log of the repository."""

    path: str
    """File below `FOLDER`."""
    sha256: str
    """First 16 digits of the file's digest."""


LOGS = {
    "board, large": Log("10_130_10_10_10_130/exp_08_17_50.txt", "f5831f3434a3d468"),
    "board, wide": Log("10_90_10_10_30_130/exp_08_15_50.txt", "0d2ef35de2a973c2"),
    "board, small": Log("30_90_30_30_30_90/exp_08_11_50_mixed.txt", "4fac45796a3a55e9"),
    "board, tiny": Log("30_63.33_43.33_30_43.33_63.33/exp_08_17_50.txt", "7b8c9bedee305a0d"),
    "board, patch": Log("patch/exp_08_18_1435_50.txt", "b5f4bcb6f100ea95"),
    "wood, large": Log("wood_10_130_10_10_10_130/exp_08_17_50.txt", "bce58376c5a93c30"),
    "wood, wide": Log("wood_10_90_10_10_30_130/exp_08_18_1100_50.txt", "b2743297306a14dc"),
    "wood, small": Log("wood_30_90_30_30_30_90/exp_08_17_0922_50.txt", "7ca18d2e171b614c"),
    "wood, tiny": Log("wood_30_63.33_43.33_30_43.33_63.33/exp_08_18_1330_50.txt", "58737664e9e45fae"),
    "wood, patch": Log("wood_patch/exp_08_17_0839_50.txt", "e30da8bd9d1e4e16"),
}
"""Name, "surface, support" -> log. 50 pushes each."""
HELD_OUT = {
    "board, wide, exp_08_11_20": Log("10_90_10_10_30_130/exp_08_11_20.txt", "585568aa8c637e21"),
    "board, wide, exp_08_11_30": Log("10_90_10_10_30_130/exp_08_11_30.txt", "76e38656135cf3fd"),
    "board, small, exp0": Log("30_90_30_30_30_90/exp0.txt", "eadc27cd7d73a795"),
    "board, small, exp08_11_20": Log("30_90_30_30_30_90/exp08_11_20.txt", "af7ec58d2f212e85"),
    "board, small, exp1": Log("30_90_30_30_30_90/exp1.txt", "7dd1442b7eef12a4"),
    "board, small, exp10_15": Log("30_90_30_30_30_90/exp10_15.txt", "ea59d26d352e220d"),
    "board, small, exp2_20": Log("30_90_30_30_30_90/exp2_20.txt", "ee390019a7cd67c8"),
    "board, small, exp2_30": Log("30_90_30_30_30_90/exp2_30.txt", "66634aeddc9d74d3"),
    "board, small, exp3_30": Log("30_90_30_30_30_90/exp3_30.txt", "d23cc18252ed8357"),
    "board, small, exp4_10": Log("30_90_30_30_30_90/exp4_10.txt", "9d499c8224161659"),
    "board, small, exp4_10_2": Log("30_90_30_30_30_90/exp4_10_2.txt", "549fa6181b8418a2"),
    "board, small, exp5_15": Log("30_90_30_30_30_90/exp5_15.txt", "32f6d460d4db82b2"),
    "board, small, exp6_5": Log("30_90_30_30_30_90/exp6_5.txt", "1e3cd6b487477d75"),
    "board, small, exp7_20": Log("30_90_30_30_30_90/exp7_20.txt", "bea67c0f4a6e6200"),
    "board, small, exp8_35_mixed": Log("30_90_30_30_30_90/exp8_35_mixed.txt", "436afc59b54c11ee"),
    "board, small, exp9_15": Log("30_90_30_30_30_90/exp9_15.txt", "f6b4a09cd06313bc"),
    "board, small, exp9_20": Log("30_90_30_30_30_90/exp9_20.txt", "433b14b527e7ad4f"),
    "board, small, exp_08_11_30": Log("30_90_30_30_30_90/exp_08_11_30.txt", "5706c2f9a2c15d61"),
}
"""The smaller logs of the same supports, of which nothing in this project was fixed."""
