"""Seeds of training and evaluation, apart by construction.

Environment i of a vector environment made with seed s is seeded s + i.
"""

ROWS = 2**14
"""Most environments of a run."""
RUNS = 2**16
"""Seeds of runs are below this."""
HELD_OUT = 2**30
"""Seeds of evaluations begin here; ROWS times RUNS, the first that no training reaches."""


def training(seed: int) -> int:
    """Seed of the first environment of a run, whose own is 0 to RUNS - 1.

    Raises:
        ValueError: It is out of range.
    """
    if not 0 <= seed < RUNS:
        raise ValueError(f"seed = {seed!r} must be a whole number >= 0 and < {RUNS}")
    return ROWS * seed


def held_out(number: int) -> int:
    """Seed of an evaluation's episode, counted from 0."""
    return HELD_OUT + number
