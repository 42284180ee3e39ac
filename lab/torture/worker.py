"""Makes cases of one attack and appends their outcomes to a file: attack, seed, first, last, file."""

from __future__ import annotations

import resource
import sys
import warnings

from lab.torture.run import ATTACKS, outcome

MEMORY = 8 * 2**30
"""Largest address space of a process [bytes]."""


def main(name: str, seed: str, first: str, last: str, path: str) -> None:
    """Make the cases from `first` up to `last`."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("ignore")
    for k in range(int(first), int(last)):
        line = outcome(ATTACKS[name], int(seed), k)
        with open(path, "a", encoding="utf-8") as file:
            file.write(line.replace("\n", " ") + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
