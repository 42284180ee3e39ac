"""Compiled functions as parts of one program, which is optimised once.

Numba makes machine code of every compiled function, and optimises a function again in each of its callers.
Here a function that another one calls is only translated; the function that Python calls is optimised with
its parts.
"""

from __future__ import annotations

import gc
import inspect
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

from llvmlite import binding
from numba.core import sigutils
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher
from numba.core.target_extension import cpu_target, jit_registry

from estimator._numba.quicker import quick_compiler
from estimator._numba.references import without_counts_of_arguments


class _PartLibrary(JITCodeLibrary):
    """Translated code of a function, neither optimised nor made executable."""

    def finalize(self) -> None:
        """Ends the translation."""
        self._finalize_dynamic_globals()
        for function in self._final_module.functions:  # may be defined in several modules that are linked
            if not function.is_declaration and function.linkage == binding.Linkage.external:
                function.linkage = "linkonce_odr"
        self._finalized = True
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)

    @property
    def has_dynamic_globals(self) -> bool:
        """Whether the code holds addresses of this process."""
        return any(library._dynamic_globals for library in (self, *_parts(self)))

    def own_module(self) -> Any:
        """The function's own code, to be linked."""
        self._ensure_finalized()
        return self._final_module

    def _get_module_for_linking(self) -> Any:
        """The function's code and that of its parts, for callers that are compiled by numba itself."""
        whole = self.own_module().clone()
        for library in _parts(self):
            whole.link_in(_module(library), preserve=True)
        return whole


class _ProgramLibrary(JITCodeLibrary):
    """Code of a function and of all its parts."""

    def finalize(self) -> None:
        """Links, optimises and makes executable."""
        self._codegen._check_llvm_bugs()
        self._raise_if_finalized()
        for library in _parts(self):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(_module(library), preserve=True)
        missing = [f.name for f in self._final_module.functions if f.is_declaration and _is_ours(f.name)]
        if missing:
            raise RuntimeError(f"compiled functions were not linked: {', '.join(missing)}")
        self._optimize_final_module()
        self._final_module.verify()
        self._finalize_final_module()

    def _optimize_final_module(self) -> None:
        """Optimises once: numba first inlines with a pass of its own, for which nothing is left here.

        References are counted until then, and removed where they are an argument's.
        """
        passes, builder = self._codegen._module_pass_manager(opt=2)
        passes.run(self._final_module, builder)
        self._final_module = without_counts_of_arguments(self._final_module)


def _leave_to_the_program(self: JITCodeLibrary, ll_module: Any) -> None:
    """`JITCodeLibrary._optimize_functions`: functions are optimised with the program they are in."""
    ll_module.data_layout = self._codegen._data_layout


def _is_ours(name: str) -> bool:
    """Whether a symbol is a function that numba compiled, and not one of its runtime or of LLVM."""
    return name.startswith("_ZN")


def _module(library: Any) -> Any:
    return library.own_module() if isinstance(library, _PartLibrary) else library._get_module_for_linking()


def _parts(library: Any) -> list[Any]:
    """All libraries that a library needs, each once, callers before what they call.

    The linker takes a function only if what it has so far calls it.
    """
    found: set[int] = set()
    order: list[Any] = []

    def visit(parent: Any) -> None:
        for part in parent._linking_libraries:
            if id(part) not in found:
                found.add(id(part))
                part._ensure_finalized()
                if isinstance(part, _PartLibrary):
                    visit(part)
                order.append(part)

    visit(library)
    return order[::-1]


class _PartCompiler(Compiler):
    """Compiles into a `_PartLibrary`."""

    def __init__(self, typing: Any, target: Any, library: Any, arguments: Any, *rest: Any) -> None:
        result, flags, types = rest
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        flags.release_gil = False  # what numba compiles for a part is then found again by others
        library = _PartLibrary(target.codegen(), "part")
        super().__init__(typing, target, library, arguments, result, flags, types)


class _ProgramCompiler(Compiler):
    """Compiles into a `_ProgramLibrary`."""

    def __init__(self, typing: Any, target: Any, library: Any, *rest: Any) -> None:
        library = _ProgramLibrary(target.codegen(), "program")
        library.enable_object_caching()
        super().__init__(typing, target, library, *rest)


class _Part(CPUDispatcher):
    """A function inside of other compiled functions."""

    _compiler: Any

    def compile(self, sig: Any) -> Any:
        """Translate the function for a signature; returns the key that numba finds it by."""
        arguments, result = sigutils.normalize_signature(sig)
        with global_compiler_lock, self._compiling_counter:
            known = self.overloads.get(tuple(arguments))
            if known is not None:
                return known.entry_point
            key = _Key()
            translated = self._compiler.compile(arguments, result)._replace(entry_point=key)
            self.targetctx.insert_user_function(key, translated.fndesc, [translated.library])
            self.overloads[tuple(arguments)] = translated
            return key


@contextmanager
def _compiling() -> Iterator[None]:
    """Functions of numba itself, such as `min` for two types, are compiled as parts meanwhile.

    No function is optimised before the program that it is in.
    """
    before, optimize = jit_registry[cpu_target], JITCodeLibrary._optimize_functions

    def decorator(**options: Any) -> Any:
        def part(function: Any) -> Any:
            plain = before(**options)(function)
            return _Part(function, plain.locals, plain.targetoptions, pipeline_class=_PartCompiler)

        return part

    with global_compiler_lock, resting(), quick_compiler():
        dict.__setitem__(jit_registry, cpu_target, decorator)
        JITCodeLibrary._optimize_functions = _leave_to_the_program
        try:
            yield
        finally:
            dict.__setitem__(jit_registry, cpu_target, before)
            JITCodeLibrary._optimize_functions = optimize


MANY = 100_000
"""Objects that the compiler makes for some functions; a program that is loaded makes far fewer."""


@contextmanager
def resting() -> Iterator[None]:
    """The garbage collector rests: the compiler makes millions of objects that live until it is done.

    If it made that many, they count as old afterwards: what is garbage among them goes with the next full
    collection, and the next small one does not look through all of them.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            made, *_ = gc.get_count()
            if made > MANY and not gc.get_freeze_count():  # what a program has frozen stays so
                gc.freeze()
                gc.unfreeze()
            gc.enable()


class _Key:
    """Stands for the machine code of a part, which has none of its own."""


class Kernel(CPUDispatcher):
    """A compiled function: a program for Python, and a part of each compiled function that calls it.

    Args:
        py_func: The function.
        locals: Types of variables.
        targetoptions: Options of `numba.njit`.
    """

    alone: Callable[[Any], AbstractContextManager[None]] = staticmethod(lambda sig: nullcontext())
    """Of a signature: keeps other processes from compiling the same program at the same time."""

    def __init__(self, py_func: Any, locals: Any = None, targetoptions: Any = None) -> None:
        py_func.__signature__ = inspect.signature(py_func)  # numba asks for it four times
        super().__init__(py_func, locals, targetoptions, pipeline_class=_ProgramCompiler)
        self.part = _Part(py_func, locals, targetoptions, pipeline_class=_PartCompiler)

    def compile(self, sig: Any) -> Any:
        """Compile or load the program for a signature; returns its entry point."""
        if sigutils.normalize_signature(sig)[0] in self.overloads:
            return super().compile(sig)
        with self.alone(sig), _compiling():
            return super().compile(sig)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Types of a call in a compiled function."""
        return self.part.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """The part for a signature."""
        return self.part.get_overload(sig)

    @property
    def is_compiling(self) -> Any:
        """Whether the function is being compiled, so that a call to it is a recursion."""
        return super().is_compiling or self.part.is_compiling


class Pointed(Kernel):
    """A compiled function that programs call through pointers, not Python: numba writes no call for it."""

    def __init__(self, py_func: Any, locals: Any = None, targetoptions: Any = None) -> None:
        super().__init__(py_func, locals, {**(targetoptions or {}), "no_cpython_wrapper": True})

    def __call__(self, *_: Any) -> Any:
        """Refuse the call."""
        raise TypeError(f"{self.__name__} is called through pointers only; its Python source is its py_func")
