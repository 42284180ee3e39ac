"""Fetches a public set, file by file, and keeps it only if every file is the known one.

Nothing that lies in a file is executed: files are bytes here, and nobody unpickles them.
"""

from __future__ import annotations

import hashlib
import urllib.parse
import urllib.request
from functools import partial
from http.client import HTTPException
from pathlib import Path

from policies.data.sets import PublicSet
from slipgym import atomic_io

RAW = "https://raw.githubusercontent.com"
PATIENCE = 30.0
"""Time without an answer after which there is no network [s]."""


def read(public: PublicSet, folder: Path, path: str) -> bytes:
    """The file of a set at a path in a clone or in what `store` made, if it is the known one.

    Raises:
        ValueError: It is missing, cannot be read, or is another file.
    """
    file, known = folder / path, public.files[path]
    try:
        size = file.stat().st_size
        data = file.read_bytes() if size == known.size else b""
    except OSError as error:
        raise ValueError(f"{file} cannot be read: {error.strerror or error}; {_by_hand(public)}") from error
    if size != known.size or not _is(data, known.sha256):
        raise ValueError(f"{file} is not the file of commit {public.commit[:7]}: other size or SHA-256")
    return data


def download(public: PublicSet, path: str) -> bytes:
    """A file of a set from its own repository.

    Raises:
        ValueError: There is no network, no such file any more, or it is another one.
    """
    known = public.files[path]
    url = f"{RAW}/{public.repository}/{public.commit}/{urllib.parse.quote(path)}"
    try:
        with urllib.request.urlopen(url, timeout=PATIENCE) as answer:
            data = answer.read(known.size + 1)
    except (OSError, HTTPException) as error:
        raise ValueError(f"cannot fetch {url}: {error}; {_by_hand(public)}") from error
    if not _is(data, known.sha256):
        raise ValueError(f"{url} is not the known file: other SHA-256; nothing was kept")
    return data


def store(public: PublicSet, target: Path, clone: Path | None = None) -> bool:
    """Puts a set into a folder, whole or not at all; returns whether it did, and not found all of it there.

    Args:
        public: The set.
        target: Folder to make; one that holds the whole set already stays as it is.
        clone: Folder to take the files from; the network if None.

    Raises:
        ValueError: A file is missing, cannot be fetched or is another one; or there is something else at
            `target`.
        OSError: The folder cannot be written.
    """
    if target.exists():
        for path in public.files:
            read(public, target, path)
        return False
    get = partial(download, public) if clone is None else partial(read, public, clone)
    atomic_io.check_folder(target.parent)
    with atomic_io.new_folder(target) as part:
        for path in public.files:
            file = part / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(get(path))
    return True


def _is(data: bytes, sha256: str) -> bool:
    return hashlib.sha256(data).hexdigest() == sha256


def _by_hand(public: PublicSet) -> str:
    return (
        f"by hand: git clone {public.url} FOLDER && git -C FOLDER checkout {public.commit}, then "
        f"slipgym data {public.name} --from FOLDER"
    )
