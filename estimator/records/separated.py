"""Reads csv files of loggers: lines above the header, units, other separators, encodings, decimal commas."""

from __future__ import annotations

import codecs
import csv
import gzip
import io
import re
from collections.abc import Callable, Collection
from itertools import islice
from pathlib import Path
from typing import Any

from estimator.records.columns import Wanted, is_wanted
from estimator.records.extras import extra
from estimator.records.table import Table

SEPARATORS = (",", ";", "\t", r"\s+")
_LOOKED_AT = 200  # lines in which the header and a decimal comma are looked for
_PIECE = 2**18  # rows that are read at once
_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF32_LE: "utf-32",  # before UTF-16, whose mark it begins with
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
_COMMENT = re.compile(r"^\s*(#|%|//)\s*")
_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?|[-+]?(nan|inf|infinity)", re.IGNORECASE)
_COMMENTS = re.compile(r"^[ \t]*(#|%|//).*$", re.MULTILINE)
_TOO_LONG = (
    "its row {} has more cells than its header has names ({}); with decimal commas, separate the cells by "
    "semicolons; no separator may end a row"
)
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")


def read_csv(path: Path, wanted: Wanted, only: bool = False) -> Table:
    """Reads a csv file, packed by gzip or not, as a table whose names may occur twice.

    The header is the line that has most of the wanted names, or else most texts, between one of
    `SEPARATORS`. Lines that begin with #, % or // are comments. A row below the header that has texts alone
    has units. A decimal comma needs another separator than the comma. With `only`, no other columns are read.

    Raises:
        ValueError: It is no text, has no header, or a row has more cells than its header.
        OSError: It cannot be opened or unpacked.
        EOFError: It is cut off.
        zlib.error: Its packing is damaged.
    """
    encoding = _encoding(path)
    return _read(lambda: io.TextIOWrapper(_binary(path), encoding), wanted, only)


def read_cells(rows: list[list[Any]], wanted: Wanted) -> Table:
    """Reads the cells of a sheet as those of a csv file; None is an empty one. As `read_csv`."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(
        [str(cell).replace("\n", " ") if isinstance(cell, str) else cell for cell in row] for row in rows
    )
    return _read(lambda: io.StringIO(text.getvalue()), wanted, wanted is not None)


def _read(open_text: Callable[[], Any], wanted: Wanted, only: bool) -> Table:
    """Reads a text that can be opened more than once."""
    pandas, expected = extra("pandas"), wanted or ()
    with open_text() as text:
        head = [line.rstrip("\n") for line in islice(text, _LOOKED_AT)]
    at, separator, names = _header(head, expected)
    with open_text() as text:
        body = _COMMENTS.sub("", "".join(islice(text, at + 1, at + 1 + _LOOKED_AT)))
    lines = [line for line in body.split("\n") if line.strip()]
    rows, units = [_cells(line, separator) for line in lines], {}
    if rows and 1 < sum(map(bool, rows[0])) == _texts(rows[0]):
        units = dict(zip(names, rows.pop(0), strict=False))
    if rows and len(rows[0]) > len(names):  # pandas would take the first columns for an index
        raise ValueError(_TOO_LONG.format(1, len(names)))
    asked = [k for k, name in enumerate(names) if is_wanted(name, wanted)]
    comma = separator != "," and any(
        _DECIMAL_COMMA.fullmatch(row[k]) for row in rows for k in asked if k < len(row)
    )
    # Before pandas 3.1 the default loses last digits of a number.
    version = tuple(int(part) for part in pandas.__version__.split(".")[:2])
    settings = {
        "sep": separator,
        "header": None,
        "names": range(len(names)),
        "usecols": asked if only else range(len(names)),  # empty cells behind them are no error
        "decimal": "," if comma else ".",
        "skipinitialspace": True,
        "low_memory": False,  # one type for all cells of a column
        **({} if version >= (3, 1) else {"float_precision": "round_trip"}),
    }
    skipped = lines[0] if units else None
    try:
        frame = _in_pieces(lambda: _Body(open_text(), at + 1, skipped, separator, len(names)), settings)
    except pandas.errors.ParserError as error:
        raise ValueError(str(error)) from error
    frame.columns = [names[k] for k in frame.columns]
    return Table(frame, names, units, comma)


def _in_pieces(open_body: Callable[[], Any], settings: dict[str, Any]) -> Any:
    """Reads rows piece by piece, which needs less memory; at once, where a column changes its type."""
    pandas = extra("pandas")
    with open_body() as body, pandas.read_csv(body, chunksize=_PIECE, **settings) as pieces:
        found = list(pieces)
    if len({tuple(piece.dtypes) for piece in found}) == 1 or all(
        dtype.kind in "if" for piece in found for dtype in piece.dtypes
    ):
        return pandas.concat(found, ignore_index=True)
    with open_body() as body:
        return pandas.read_csv(body, **settings)


class _Body(io.TextIOBase):
    """The lines of a text below its first `at`, without comments and without the row of units, if any.

    It refuses a row of more cells than `count`, unless they are empty: pandas would leave them out.
    """

    def __init__(self, text: Any, at: int, units: str | None, separator: str, count: int) -> None:
        self._text, self._units = text, units
        self._separator, self._count, self._rows = separator, count, 0
        for _ in islice(text, at):
            pass

    def read(self, size: int | None = -1) -> str:
        """Whole lines of about this length; an empty text at the end."""
        while True:
            lines = self._text.readlines(size if size and size > 0 else -1)
            text = "".join(lines)
            if any(mark in text for mark in ("#", "%", "//")):
                text = _COMMENTS.sub("", text)
            if self._units is not None and self._units in text:
                text, self._units = text.replace(self._units, "", 1), None
            if text or not lines:
                self._check(text)
                return text

    def _check(self, text: str) -> None:
        rows = [line for line in text.split("\n") if line and not line.isspace()]
        if len(self._separator) > 1:
            found = [len(row.split()) for row in rows]
        else:
            found = [1 + row.count(self._separator) for row in rows]
        for k in (k for k, cells in enumerate(found) if cells > self._count):
            if any(_cells(rows[k], self._separator)[self._count :]):
                raise ValueError(_TOO_LONG.format(1 + self._rows + k, self._count))
        self._rows += len(rows)

    def __iter__(self) -> Any:
        return iter(self._text)

    def close(self) -> None:
        """Closes the text, too."""
        self._text.close()
        super().close()


def _binary(path: Path) -> Any:
    """A file, unpacked if it is packed."""
    with path.open("rb") as file:
        packed = file.read(2) == b"\x1f\x8b"
    return gzip.open(path) if packed else path.open("rb")


def _encoding(path: Path) -> str:
    """That of a text: by its mark, or else UTF-8, or else Latin-1."""
    with _binary(path) as file:
        begin = file.read(4)
    marked = next((name for mark, name in _MARKS.items() if begin.startswith(mark)), None)
    for encoding in (marked,) if marked else ("utf-8", "latin-1"):
        line = 1
        try:
            with io.TextIOWrapper(_binary(path), encoding) as text:
                while piece := text.read(2**20):
                    if (at := piece.find("\0")) >= 0:
                        line += piece.count("\n", 0, at)
                        break
                    line += piece.count("\n")
                else:
                    return encoding
        except UnicodeDecodeError:
            if encoding != "utf-8":
                raise
            continue
        raise ValueError(f"line {line} has a character 0: it is no text, or UTF-16 without a mark")
    raise AssertionError


def _header(lines: list[str], expected: Collection[str]) -> tuple[int, str, list[str]]:
    """The place of the header, its separator, and its names."""
    best, found = (0, 0, False), None
    for at, line in enumerate(lines):
        bare = _COMMENT.sub("", line)
        split = {separator: _cells(bare, separator) for separator in SEPARATORS}
        numbers = any(len(cells) > 1 and not _texts(cells) for cells in split.values())
        for separator, names in split.items():
            known = len(set(names) & set(expected))
            texts = 0 if numbers or len(separator) > 1 else _texts(names)  # a sentence is no header
            if (score := (known, texts, bare is line)) > best and (known or texts):
                best, found = score, (at, separator, names)
    if found is None:
        raise ValueError(f"no line of names among its first {_LOOKED_AT}, and a record needs a header")
    return found


def _cells(line: str, separator: str) -> list[str]:
    if len(separator) > 1:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])]


def _texts(cells: list[str]) -> int:
    """How many cells are neither empty nor numbers."""
    return sum(1 for cell in cells if cell and not _NUMBER.fullmatch(cell))
