"""Switches the optimisations of this package off one by one, so that the benchmark can measure each.

The environment variable SLIPGYM_NUMBA_DISABLE holds names of `OPTIMISATIONS`, separated by commas. It is read
once, when `slipgym._numba` is first imported. Results are the same bit for bit. Variants have different
stamps in numba's cache, so that none runs another's code; with a NUMBA_CACHE_DIR for each they do not
overwrite each other either.
"""

from __future__ import annotations

import os

VARIABLE = "SLIPGYM_NUMBA_DISABLE"
OPTIMISATIONS = ("pointers", "prefetch")
"""What can be switched off: a module of this package each."""


def read_disabled(value: str) -> frozenset[str]:
    """Names in a value of the environment variable.

    Raises:
        ValueError: A name is not one of `OPTIMISATIONS`.
    """
    names = frozenset(name.strip() for name in value.split(",") if name.strip())
    for name in sorted(names - set(OPTIMISATIONS)):
        raise ValueError(f"{VARIABLE}: {name!r} must be one of {', '.join(OPTIMISATIONS)}")
    return names


DISABLED = read_disabled(os.environ.get(VARIABLE, ""))
"""The optimisations that are switched off in this process."""
