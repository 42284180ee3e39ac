"""A decorator like `numba.njit(cache=True)` whose cache knows what is compiled.

Numba's cache compares the file that holds a function: it does not notice when a function that is called from
another file changes, and compiles again when a comment does. Here the name of a stored program is a hash
of the function and of all that it uses, see `estimator._numba.digest`.
"""

from __future__ import annotations

import hashlib
import os
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext, suppress
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from numba.core import config, sigutils
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult

from estimator._numba import folders, program_file
from estimator._numba.digest import digest
from estimator._numba.linking import Kernel

if vars(config)["DISABLE_JIT"]:
    raise ImportError(
        "slipgym and its estimators need numba's compiler: unset NUMBA_DISABLE_JIT. To debug one compiled "
        "function, call its `py_func`"
    )

VARIANTS = 64
"""Programs of one function that are kept, the newest: for other arguments, processors or earlier sources."""


def compiler(
    variant: tuple[str, ...] = (), kind: type[Kernel] = Kernel, **options: Any
) -> Callable[[Callable[..., Any]], Any]:
    """Returns a decorator that compiles on first use and keeps the result on disk.

    The variant distinguishes programs of the same sources. `Pointed` is for functions that Python does not
    call. Options are those of `numba.njit`.
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

    Options of `numba.njit` that are not given are those of the caller, except `fastmath`, which is False:
    what a function computes does not depend on who calls it first.
    """
    decorate = compiler(**{"fastmath": False, **options})
    return decorate if function is None else decorate(function)


fused = njit(error_model="numpy", fastmath={"contract"})
"""`njit` for functions in which a product and the sum that takes it are one operation, rounded once, where
the processor has it. Which of several products is taken is fixed when the function is compiled."""


_ANNOTATION = 5
"""Place of the annotated source in the description of a program."""
_DEFINED: dict[str, tuple[str, str]] = {}
"""Symbols that this process has stored or loaded, with the key and a digest of their program."""


@cache
def _warn_unusable(reason: str, folder: Path) -> None:
    """Warn once for each reason and folder."""
    warnings.warn(f"a stored program in {folder} is not used, and compiled again: {reason}", stacklevel=2)


class ProgramCache(_Cache):
    """Programs of one function on disk: a file for each signature, digest, processor and set of versions.

    Programs are looked for among those of the user, then among those that
    the installation brings. The variant distinguishes programs of the same sources.
    """

    def __init__(self, dispatcher: Any, variant: tuple[str, ...]) -> None:
        self._dispatcher = dispatcher
        self._variant = variant
        self._enabled = True

    @cached_property
    def _folder(self) -> Path | None:
        return folders.program_folder(self._file)

    @property
    def _file(self) -> str:
        return self._dispatcher.py_func.__code__.co_filename

    @cached_property
    def _name(self) -> str:
        return f"{Path(self._file).stem}.{re.sub('[<>]', '', self._dispatcher.py_func.__qualname__)}"

    @cached_property
    def _identity(self) -> tuple[str, ...]:
        return (digest(self._dispatcher), *folders.versions().values(), *self._variant)

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
        """Load the program for a signature; None if there is none that can be used."""
        target_context.refresh()
        for path, key in self._candidates(sig, target_context.codegen()):
            try:
                machine_code, (name, kind, interface, rest) = program_file.read(path, key)
                _define(rest[0], key, machine_code)
                return CompileResult._rebuild(target_context, (name, kind, (machine_code, interface)), *rest)
            except FileNotFoundError:
                continue
            except program_file.UnusableProgramError as error:
                _warn_unusable(str(error), path.parent)
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save a compiled program, whole or not at all, and remove the oldest if there are many."""
        path, key = next(self._candidates(sig, data.codegen), (None, ""))
        if (
            path is None
            or any(not part.can_cache for part in data.lifted)
            or data.library.has_dynamic_globals
        ):
            return
        (name, kind, (machine_code, interface)), *rest = data._reduce()
        rest[_ANNOTATION] = ""  # half a megabyte of text, with the path of the source
        _DEFINED.update(dict.fromkeys(_symbols(rest[0]), (key, hashlib.sha256(machine_code).hexdigest())))
        try:
            if path.exists() and hasattr(os, "getuid") and path.stat().st_uid != os.getuid():
                path = _own(path)
            program_file.write(path, key, machine_code, (name, kind, interface, rest))
        except OSError as error:
            warnings.warn(f"the compiled {self._name} cannot be kept: {error}", stacklevel=2)
            return
        with suppress(OSError):
            for old in self._stored()[VARIANTS:]:
                old.unlink(missing_ok=True)

    def alone(self, sig: Any) -> AbstractContextManager[None]:
        """While a program that is not stored is compiled: keeps other processes from compiling it, too."""
        paths = [path for path, _ in self._candidates(sig, self._dispatcher.targetctx.codegen())]
        stored = not paths or any(path.is_file() for path in paths)
        return nullcontext() if stored else folders.only_one(paths[0].with_suffix(".lock"))

    def _candidates(self, sig: Any, codegen: Any) -> Iterator[tuple[Path, str]]:
        """Files that may hold a program, with its key; the first is the one to write.

        There are none if programs of this function or for these arguments cannot be kept.
        """
        if not self._enabled or self._folder is None:
            return
        arguments, result = sigutils.normalize_signature(sig)
        types = [str(kind) for kind in (*arguments, result)]
        if any(" at 0x" in kind for kind in types):  # a Python object, known by its address only
            return
        triple, *processor = map(str, codegen.magic_tuple())
        file, key = self._program(types, triple, *processor)
        yield self._folder / file, key
        if hasattr(os, "getuid"):
            yield _own(self._folder / file), key
        if vars(config)["CPU_NAME"] is None and folders.runs_shipped():
            file, key = self._program(types, triple, folders.TARGET, "")
            yield folders.SHIPPED / folders.place(Path(self._file).absolute().parent) / file, key

    def _program(self, types: list[str], *target: str) -> tuple[str, str]:
        """Name of a program's file, and its key."""
        key = hashlib.sha256("\0".join([*types, *target, *self._identity]).encode()).hexdigest()
        return f"{self._name}-{key[:24]}.nbc", key

    def _path(self, sig: Any, codegen: Any) -> Path | None:
        """The file to write."""
        return next(self._candidates(sig, codegen), (None, ""))[0]

    def _stored(self) -> list[Path]:
        """All programs of the function, the newest first."""
        if self._folder is None:
            return []
        pattern = re.compile(rf"{re.escape(self._name)}-[0-9a-f]{{24}}(\.user\d+)?\.nbc")
        found = [path for path in self._folder.iterdir() if pattern.fullmatch(path.name)]
        return sorted(found, key=lambda path: (path.stat().st_mtime_ns, path.name), reverse=True)


def _own(path: Path) -> Path:
    """The file beside a program that another user has written: that one is not loaded."""
    return path.with_suffix(f".user{os.getuid()}.nbc")


def _symbols(descriptor: Any) -> list[str]:
    """Symbols that a program defines for others."""
    kinds = "llvm_func_name", "llvm_cpython_wrapper_name", "llvm_cfunc_wrapper_name"
    return [getattr(descriptor, kind) for kind in kinds]


def _define(descriptor: Any, key: str, machine_code: bytes) -> None:
    """Take down the symbols of a program that is about to be loaded.

    Raises:
        program_file.UnusableProgramError: Another program defines one of them already.
    """
    program = key, hashlib.sha256(machine_code).hexdigest()
    for symbol in _symbols(descriptor):
        if _DEFINED.setdefault(symbol, program) != program:
            raise program_file.UnusableProgramError(f"another program defines {symbol[:80]}")
