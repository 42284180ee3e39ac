"""Runs the campaign: attacks in processes of their own, so that a crash or an endless call is an outcome."""

from __future__ import annotations

import os
import subprocess
import sys
import time
import zlib
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

from lab.torture import arguments, crafted, endurance
from lab.torture.cases import Attack

ATTACKS = {each.name: each for each in (*arguments.ATTACKS, *crafted.ATTACKS, *endurance.ATTACKS)}
"""Name -> attack."""
START_UP = 120.0
"""Time that a process may take to import and compile [s]."""
STANDSTILL = 20.0
"""Times as long by the clock: a case that waits for ever uses no processor."""
BATCH = 500
"""Cases of a process: what leaks in one does not last."""


def outcome(attack: Attack, seed: int, k: int) -> str:
    """Make a case.

    Args:
        attack: The attack.
        seed: Of the campaign.
        k: Number of the case; with the seed it decides everything.

    Returns:
        Its outcome; "unexplained: ..." for an exception that the attack does not expect.
    """
    rng = np.random.default_rng([seed, zlib.crc32(attack.name.encode()), k])
    try:
        return attack.case(rng)
    except Exception as error:
        return f"unexplained: {type(error).__name__}: {str(error).partition(chr(10))[0]:.150}"


def run(
    folder: Path, seed: int, share: float, names: list[str], report: Callable[[str], None] = print
) -> str:
    """Carry out a campaign, on from where its folder stands.

    Args:
        folder: Where outcomes are kept, a file for each attack.
        seed: Of the campaign; a folder belongs to one.
        share: Fraction of the cases of a full campaign.
        names: Attacks; none: all.
        report: Called with a line about each attack that has ended.

    Returns:
        The table.

    Raises:
        ValueError: An attack is unknown, or the folder belongs to another seed.
    """
    for name in names:
        if name not in ATTACKS:
            raise ValueError(f"unknown attack {name!r}; valid: {', '.join(ATTACKS)}")
    folder.mkdir(parents=True, exist_ok=True)
    note = folder / "seed"
    if note.exists() and note.read_text() != str(seed):
        raise ValueError(f"{folder} holds a campaign with seed {note.read_text()}")
    note.write_text(str(seed))
    chosen = [ATTACKS[name] for name in names or ATTACKS]
    for attack in chosen:
        start = time.monotonic()
        _carry_out(folder, attack, seed, max(1, round(share * attack.count)))
        report(f"{attack.name}: {time.monotonic() - start:.0f} s")
    return table(folder, chosen)


def table(folder: Path, attacks: list[Attack]) -> str:
    """The outcomes as a table, those that nothing explains last, with their cases."""
    lines = ["| attack | cases | outcomes | unexplained |", "| --- | --- | --- | --- |"]
    unexplained = []
    for attack in attacks:
        found = _outcomes(folder, attack)
        counts = Counter(found)
        wrong = [(k, each) for k, each in enumerate(found) if each not in attack.allowed]
        shown = ", ".join(f"{counts[each]} {each}" for each in attack.allowed if counts[each])
        lines.append(f"| {attack.name} | {len(found)} | {shown} | {len(wrong)} |")
        unexplained += [f"{attack.name}, case {k}: {each}" for k, each in wrong]
    return "\n".join([*lines, "", *unexplained]).rstrip()


def _carry_out(folder: Path, attack: Attack, seed: int, total: int) -> None:
    while (done := len(_outcomes(folder, attack))) < total:
        last = min(total, done + BATCH)
        command = [sys.executable, "-m", "lab.torture.worker", attack.name, str(seed)]
        process = subprocess.Popen(
            [*command, str(done), str(last), str(_file(folder, attack))],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            ended = _watched(process, folder, attack)
        finally:
            process.kill()
            process.wait()
        if len(_outcomes(folder, attack)) < last:
            status = f"crash: exit status {process.returncode}" if ended else "endless"
            with _file(folder, attack).open("a", encoding="utf-8") as file:
                file.write(status + "\n")


def _watched(process: subprocess.Popen, folder: Path, attack: Attack) -> bool:
    """Wait for a process; False if a case takes too much of the processor, or stands still."""
    known, since, patience = -1, (0.0, time.monotonic()), START_UP
    while process.poll() is None:
        found, now = len(_outcomes(folder, attack)), (_worked(process.pid), time.monotonic())
        if found != known:
            patience = START_UP if known < 0 else attack.seconds
            known, since = found, now
        if now[0] - since[0] > patience or now[1] - since[1] > STANDSTILL * patience:
            return False
        time.sleep(0.1)
    return True


def _worked(pid: int) -> float:
    """Processor time of a process, so that other work on the machine does not count [s]."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:  # it has ended, or this is no Linux
        return time.monotonic()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _file(folder: Path, attack: Attack) -> Path:
    return folder / f"{attack.name.replace(' ', '_')}.txt"


def _outcomes(folder: Path, attack: Attack) -> list[str]:
    """Outcomes so far, whole lines alone: a process may be writing."""
    path = _file(folder, attack)
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return text[: text.rfind("\n") + 1].splitlines()
