"""Reads csv files whose cells are between commas, semicolons or tabs; with the latter, decimal commas too."""

from __future__ import annotations

import csv
import gzip
import re
from itertools import islice
from pathlib import Path
from typing import Any

from estimator.records.extras import extra

SEPARATORS = (",", ";", "\t")
_LOOKED_AT = 200  # lines in which a decimal comma is looked for
_DECIMAL_COMMA = re.compile(r"\d,\d")


def read_csv(path: Path) -> tuple[Any, list[str]]:
    """Reads a csv or csv.gz file.

    The separator is the one that the header has most of; a decimal comma needs another one than the comma.

    Args:
        path: The file.

    Returns:
        Its pandas.DataFrame, and the names in its header as they are, where a name may occur twice.

    Raises:
        ValueError: It cannot be read, or its rows have more cells than its header.
        OSError: It cannot be opened or unpacked.
    """
    pandas, opened = extra("pandas"), gzip.open if path.suffix == ".gz" else open
    with opened(path, "rt", encoding="utf-8-sig", errors="replace", newline="") as file:
        header, *rows = list(islice(file, _LOOKED_AT)) or [""]
    separator = max(SEPARATORS, key=header.count)
    comma = separator != "," and any(_DECIMAL_COMMA.search(row) for row in rows)
    # Before pandas 3.1 the default loses last digits of a number.
    version = tuple(int(part) for part in pandas.__version__.split(".")[:2])
    exactly = {} if version >= (3, 1) else {"float_precision": "round_trip"}
    frame = pandas.read_csv(path, sep=separator, decimal="," if comma else ".", **exactly)
    names = next(csv.reader([header.rstrip("\r\n")], delimiter=separator), [])
    if not isinstance(frame.index, pandas.RangeIndex):  # pandas takes the first columns for an index
        raise ValueError(
            f"its rows have more cells than its header has names ({len(names)}); with decimal commas, "
            "separate the cells by semicolons; no separator may end a row"
        )
    return frame, names
