"""Reads csv files of loggers: lines above the header, units, other separators, encodings, decimal commas."""

from __future__ import annotations

import codecs
import csv
import gzip
import io
import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

from estimator.records.extras import extra

SEPARATORS = (",", ";", "\t", r"\s+")
_LOOKED_AT = 200  # lines in which the header and a decimal comma are looked for
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
    "its rows have more cells than its header has names ({}); with decimal commas, separate the cells by "
    "semicolons; no separator may end a row"
)
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")


def read_csv(path: Path, expected: Collection[str]) -> tuple[Any, dict[str, str], bool]:
    """Reads a csv file, packed by gzip or not.

    The header is the line that has most of the expected names, or else most texts, between one of
    `SEPARATORS`. Lines that begin with #, % or // are comments. A row below the header that has texts alone
    has units. A decimal comma needs another separator than the comma.

    Args:
        path: The file.
        expected: The columns that may be read.

    Returns:
        Its pandas.DataFrame, whose names may occur twice; column -> unit that the file says; whether its
        numbers have decimal commas.

    Raises:
        ValueError: It is no text, has no header, or its rows have more cells than its header.
        OSError: It cannot be opened or unpacked.
        EOFError: It is cut off.
        zlib.error: Its packing is damaged.
    """
    pandas, text = extra("pandas"), _text(path)
    at, separator, names = _header(text.split("\n", _LOOKED_AT)[:_LOOKED_AT], expected)
    body = "".join(text.split("\n", at + 1)[at + 1 :])
    if any(mark in body for mark in ("#", "%", "//")):
        body = _COMMENTS.sub("", body)
    lines = [line for line in body.split("\n", _LOOKED_AT)[:_LOOKED_AT] if line.strip()]
    rows, units = [_cells(line, separator) for line in lines], {}
    if rows and 1 < sum(map(bool, rows[0])) == _texts(rows[0]):
        units = dict(zip(names, rows.pop(0), strict=False))
        body = body.replace(lines[0], "", 1)
    if rows and len(rows[0]) > len(names):  # pandas would take the first columns for an index
        raise ValueError(_TOO_LONG.format(len(names)))
    read = [cell for row in rows for name, cell in zip(names, row, strict=False) if name in expected]
    comma = separator != "," and any(map(_DECIMAL_COMMA.fullmatch, read))
    # Before pandas 3.1 the default loses last digits of a number.
    version = tuple(int(part) for part in pandas.__version__.split(".")[:2])
    exactly = {} if version >= (3, 1) else {"float_precision": "round_trip"}
    try:
        frame = pandas.read_csv(
            io.BytesIO(body.encode()),
            sep=separator,
            header=None,
            names=range(len(names)),
            decimal="," if comma else ".",
            skipinitialspace=True,
            low_memory=False,  # one type for all cells of a column
            **exactly,
        )
    except pandas.errors.ParserError as error:
        longer = re.search(r"Expected \d+ fields", str(error))
        raise ValueError(_TOO_LONG.format(len(names)) if longer else str(error)) from error
    frame.columns = names
    return frame, units, comma


def _text(path: Path) -> str:
    """All of a file, unpacked, with line ends as Python has them; without a mark, UTF-8 or else Latin-1."""
    data = path.read_bytes()
    if data.startswith(b"\x1f\x8b"):
        data = gzip.decompress(data)
    encoding = next((name for mark, name in _MARKS.items() if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError:
        if encoding != "utf-8":
            raise
        text = data.decode("latin-1")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if (at := text.find("\0")) >= 0:
        line = text.count("\n", 0, at) + 1
        raise ValueError(f"line {line} has a character 0: it is no text, or UTF-16 without a mark")
    return text


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
