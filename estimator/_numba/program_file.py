"""Reads and writes program files.

A file holds a head, the key that says what was compiled, a SHA-256 digest of key and content, and as content
machine code and, packed, the descriptions that numba needs to call it. Loading a description runs code: a
file is therefore read only if it belongs to the user, to root or to the owner of the installation, and if
nobody else can write to it, and only after its digest was compared.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import stat
import uuid
import zlib
from pathlib import Path
from typing import Any

from numba.core.serialize import dumps

HEAD = b"slipgym program 5\n"
"""First bytes; another format has another head."""
_KEY, _DIGEST, _LENGTH = 64, 32, 8


class UnusableProgramError(Exception):
    """A program file that must not be used; the message says why."""


def trusted_owners() -> set[int]:
    """Numbers of the users whose files may be loaded."""
    return {0, os.getuid(), Path(__file__).stat().st_uid}


def read(path: Path, key: str) -> tuple[bytes, Any]:
    """Machine code and description of a program.

    Args:
        path: The file.
        key: What the program must have been compiled from, 64 hexadecimal digits.

    Raises:
        FileNotFoundError: There is no such file.
        UnusableProgramError: The file cannot be read, is damaged, holds another program or is not the user's.
    """
    try:
        with open(path, "rb") as file:
            _check_owner(os.fstat(file.fileno()))
            data = file.read()
    except FileNotFoundError:
        raise
    except OSError as error:
        raise UnusableProgramError(error.strerror or type(error).__name__) from error
    start = len(HEAD) + _KEY + _DIGEST
    content = data[start:]
    if not data.startswith(HEAD) or len(content) < _LENGTH:
        raise UnusableProgramError("it is no program file of this version")
    found = data[len(HEAD) : len(HEAD) + _KEY]
    if data[len(HEAD) + _KEY : start] != hashlib.sha256(found + content).digest():
        raise UnusableProgramError("it is damaged")
    if found != key.encode():
        raise UnusableProgramError("it holds another program")
    end = _LENGTH + int.from_bytes(content[:_LENGTH], "little")
    try:
        return content[_LENGTH:end], pickle.loads(zlib.decompress(content[end:]))
    except Exception as error:  # a class of the program has moved, for example
        raise UnusableProgramError(f"{type(error).__name__}: {error}") from error


def _check_owner(state: os.stat_result) -> None:
    if not stat.S_ISREG(state.st_mode):
        raise UnusableProgramError("it is no plain file")
    if hasattr(os, "getuid"):
        if state.st_uid not in trusted_owners():
            raise UnusableProgramError(f"it belongs to another user, number {state.st_uid}")
        if state.st_mode & 0o022:
            raise UnusableProgramError("others can write to it")


def write(path: Path, key: str, machine_code: bytes, description: Any) -> None:
    """Write a program, whole or not at all.

    Raises:
        OSError: The file cannot be written.
    """
    content = len(machine_code).to_bytes(_LENGTH, "little") + machine_code + zlib.compress(dumps(description))
    digest = hashlib.sha256(key.encode() + content).digest()
    temporary = path.with_name(f"{path.name}.tmp.{uuid.uuid4().hex[:16]}")
    try:
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        with open(descriptor, "wb") as file:
            file.write(HEAD + key.encode() + digest + content)
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
