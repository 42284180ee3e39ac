"""Compilation of the estimators' kernels and their cache on disk.

`caching.compiler` stores programs under a digest of all that is compiled into them.
`entry_point` compiles the function of an estimator that Python calls, once, at import.

Raises:
    ImportError: numba is older than the oldest version that slipgym was tried with.
"""

import re

import llvmlite
import numba

OLDEST = (0, 63)
"""Oldest version of numba that slipgym was tried with."""

_found = tuple(int(number) for number in re.findall(r"\d+", numba.__version__)[:2])
if _found < OLDEST:
    raise ImportError(
        f"slipgym needs numba>={'.'.join(map(str, OLDEST))}; numba {numba.__version__} with llvmlite "
        f"{llvmlite.__version__} is installed"
    )
