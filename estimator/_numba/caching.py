"""A decorator like `numba.njit(cache=True)` whose cache knows what is compiled.

Numba's cache compares the file that holds a function: it does not notice when a function that is called from
another file changes, and compiles again when a comment does. Here the name of a stored program is a hash
of the function and of all that it uses, see `estimator._numba.digest`.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import re
import sys
import uuid
import warnings
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cached_property
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core import config, sigutils
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from estimator._numba.digest import digest
from estimator._numba.folders import program_folder
from estimator._numba.linking import Kernel
from estimator._numba.locking import only_one

if vars(config)["DISABLE_JIT"]:
    raise ImportError(
        "slipgym and its estimators need numba's compiler: unset NUMBA_DISABLE_JIT. To debug one compiled "
        "function, call its `py_func`"
    )

VARIANTS = 16
"""Programs of one function that are kept, the newest: for other arguments, processors or earlier sources."""
_UNREADABLE = (OSError, EOFError, ValueError, TypeError, LookupError, AttributeError, ImportError)


def compiler(
    variant: tuple[str, ...] = (), kind: type[Kernel] = Kernel, **options: Any
) -> Callable[[Callable[..., Any]], Any]:
    """Returns a decorator that compiles on first use and keeps the result on disk.

    Args:
        variant: Distinguishes programs of the same sources.
        kind: `Kernel`, or `Pointed` for functions that Python does not call.
        **options: Options of `numba.njit`.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher: Any = kind(function, targetoptions={"nopython": True, "boundscheck": None, **options})
        cache = ProgramCache(dispatcher, variant)
        dispatcher._cache = cache  # numba has no public option for another cache
        dispatcher.alone = cache.alone
        return dispatcher

    return compiled


def njit(function: Any = None, **options: Any) -> Any:
    """Decorates a function that other compiled functions call: it becomes a part of their programs.

    Args:
        function: The function, if the decorator is used without options.
        **options: Options of `numba.njit`; those that are not given are those of the caller, except
            `fastmath`, which is False: what a function computes does not depend on who calls it first.
    """
    decorate = compiler(**{"fastmath": False, **options})
    return decorate if function is None else decorate(function)


fused = njit(error_model="numpy", fastmath={"contract"})
"""`njit` for functions in which a product and the sum that takes it are one operation, rounded once, where
the processor has it. Which of several products is taken is fixed when the function is compiled."""


FORMAT = "4"
"""Of the stored programs: another one makes none of the old ones valid."""


class ProgramCache(_Cache):
    """Programs of one function on disk: a file for each signature, digest, processor and set of versions.

    Args:
        dispatcher: The function.
        variant: Distinguishes programs of the same sources.
    """

    def __init__(self, dispatcher: Any, variant: tuple[str, ...]) -> None:
        self._dispatcher = dispatcher
        self._variant = variant
        self._enabled = True

    @cached_property
    def _folder(self) -> Path | None:
        return program_folder(self._dispatcher.py_func.__code__.co_filename)

    @cached_property
    def _name(self) -> str:
        function = self._dispatcher.py_func
        return f"{Path(function.__code__.co_filename).stem}.{re.sub('[<>]', '', function.__qualname__)}"

    @cached_property
    def _identity(self) -> tuple[str, ...]:
        versions = numba.__version__, llvmlite.__version__, str(sys.implementation.cache_tag), FORMAT
        return (digest(self._dispatcher), *versions, *self._variant)

    @property
    def cache_path(self) -> str | None:
        """The folder; None if there is none that can be written."""
        return None if self._folder is None else str(self._folder)

    def enable(self) -> None:
        """Use the cache."""
        self._enabled = True

    def disable(self) -> None:
        """Use no cache."""
        self._enabled = False

    def flush(self) -> None:
        """Remove all programs of the function."""
        for path in self._stored():
            path.unlink(missing_ok=True)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the program for a signature; None if there is none."""
        target_context.refresh()
        path = self._path(sig, target_context.codegen())
        if path is None:
            return None
        try:
            payload = pickle.loads(path.read_bytes())
        except (*_UNREADABLE, pickle.UnpicklingError):
            return None
        return CompileResult._rebuild(target_context, *payload)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save a compiled program, whole or not at all, and remove the oldest if there are many."""
        path = self._path(sig, data.codegen)
        if (
            path is None
            or any(not part.can_cache for part in data.lifted)
            or data.library.has_dynamic_globals
        ):
            return
        temporary = path.with_name(f"{path.name}.tmp.{uuid.uuid4().hex[:16]}")
        try:
            temporary.write_bytes(dumps(data._reduce()))
            os.replace(temporary, path)
            for old in self._stored()[VARIANTS:]:
                old.unlink(missing_ok=True)
        except OSError as error:
            temporary.unlink(missing_ok=True)
            warnings.warn(f"the compiled {self._name} cannot be kept: {error}", stacklevel=2)

    def alone(self, sig: Any) -> AbstractContextManager[None]:
        """While a program that is not stored is compiled: keeps other processes from compiling it, too."""
        path = self._path(sig, self._dispatcher.targetctx.codegen())
        return nullcontext() if path is None or path.is_file() else only_one(path.with_suffix(".lock"))

    def _path(self, sig: Any, codegen: Any) -> Path | None:
        """File of a program; None if programs of this function or for these arguments cannot be kept."""
        if not self._enabled or self._folder is None:
            return None
        arguments, result = sigutils.normalize_signature(sig)
        types = [str(kind) for kind in (*arguments, result)]
        if any(" at 0x" in kind for kind in types):  # a Python object, known by its address only
            return None
        key = "\0".join([*types, *map(str, codegen.magic_tuple()), *self._identity])
        return self._folder / f"{self._name}-{hashlib.sha256(key.encode()).hexdigest()[:24]}.nbc"

    def _stored(self) -> list[Path]:
        """All programs of the function, the newest first."""
        if self._folder is None:
            return []
        pattern = re.compile(rf"{re.escape(self._name)}-[0-9a-f]{{24}}\.nbc")
        with os.scandir(self._folder) as entries:
            found = [
                (entry.stat().st_mtime_ns, entry.name) for entry in entries if pattern.fullmatch(entry.name)
            ]
        return [self._folder / name for _, name in sorted(found, reverse=True)]
