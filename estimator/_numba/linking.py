"""Links compiled functions into programs.

Numba makes machine code of every compiled function and optimises it again in each of its callers. Here a
function that another one calls is only translated, as a part; the function that Python calls is optimised
once, with its parts. Only its entry points can be seen by other programs, and every symbol holds a hash of
the code that it stands for: no order of compiling or loading programs can mix them up.
"""

from __future__ import annotations

import gc
import hashlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from typing import Any

from llvmlite import binding
from numba.core import sigutils
from numba.core.bytecode import FunctionIdentity
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher
from numba.core.untyped_passes import ExtractByteCode

from estimator._numba.digest import digest

EXTERNAL = binding.Linkage.external


class _Library(JITCodeLibrary):
    """Code that is optimised with the program that it is in, and not before."""

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def exported(self) -> list[str]:
        """Names of the functions defined so far that other modules can see."""
        functions = self._final_module.functions
        return [f.name for f in functions if not f.is_declaration and f.linkage == EXTERNAL]

    def set_linkage(self, names: list[str], linkage: str) -> None:
        """Set who can see some functions."""
        for name in names:
            self._final_module.get_function(name).linkage = linkage


class _PartLibrary(_Library):
    """Translated code of a function, neither optimised nor made executable."""

    def finalize(self) -> None:
        """Ends the translation."""
        self._finalize_dynamic_globals()
        self.set_linkage(self.exported(), "linkonce_odr")  # several modules that are linked may define it
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        self._finalized = True

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


class _ProgramLibrary(_Library):
    """Code of a function and of all its parts."""

    entries: list[str]

    def finalize(self) -> None:
        """Links, optimises and makes executable."""
        self._codegen._check_llvm_bugs()
        self._raise_if_finalized()
        self.entries = self.exported()
        for library in _parts(self):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(_module(library), preserve=True)
        # numba numbers its own functions anew in each process: the names of two programs' parts may be equal
        defined = {function.name for function in self._final_module.functions if not function.is_declaration}
        self.set_linkage(sorted(defined - {*self.entries}), "internal")
        self._optimize_final_module()
        self._final_module.verify()
        self._finalize_final_module()

    def _optimize_final_module(self) -> None:
        """Optimises once: numba first inlines with a pass of its own, for which nothing is left here."""
        passes, builder = self._codegen._module_pass_manager(opt=2)
        passes.run(self._final_module, builder)

    def _get_module_for_linking(self) -> Any:
        """A module that names the entry points: callers link the part, so a program's file needs no more."""
        stubs = "\n".join(f'define void @"{name}"() {{ ret void }}' for name in self.entries)
        return binding.parse_assembly(stubs)


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


class _NamedCompiler(Compiler):
    """Names what it compiles after its content.

    Numba numbers functions and records in the order in which a process meets them. Two processes give two
    programs the same names, and a third that loads both would run the first for both.

    Args:
        kernel: The function, as `digest` takes it.
        *arguments: Those of numba's compiler.
    """

    library: Callable[..., Any]

    def __init__(
        self, kernel: Any, typing: Any, target: Any, library: Any, arguments: Any, *rest: Any
    ) -> None:
        super().__init__(typing, target, self.library(target.codegen(), "slipgym"), arguments, *rest)
        self.kernel = kernel

    def compile_extra(self, func: Any) -> Any:
        """Compile a function; as numba's own, but for the name."""
        state = self.state
        content = "\0".join(
            [digest(self.kernel), str(state.flags), *map(str, (*state.args, state.return_type))]
        )
        identity: Any = FunctionIdentity.from_function(func)
        identity.unique_id = hashlib.sha256(content.encode()).hexdigest()[:32]
        identity.unique_name = f"{identity.func_qualname}${identity.unique_id}"
        state.func_id, state.lifted, state.lifted_from = identity, (), None
        ExtractByteCode().run_pass(state)
        return self._compile_bytecode()


class _PartCompiler(_NamedCompiler):
    """Compiles into a `_PartLibrary`."""

    library = _PartLibrary

    def __init__(self, kernel: Any, *arguments: Any) -> None:
        *first, result, flags, types = arguments
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        flags.release_gil = False  # what numba compiles for a part is then found again by others
        super().__init__(kernel, *first, result, flags, types)


class _ProgramCompiler(_NamedCompiler):
    """Compiles into a `_ProgramLibrary`."""

    @staticmethod
    def library(codegen: Any, name: str) -> Any:
        """A library whose machine code can be stored."""
        library = _ProgramLibrary(codegen, name)
        library.enable_object_caching()
        return library


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
def resting() -> Iterator[None]:
    """The garbage collector rests: the compiler makes millions of objects that live until it is done."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
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
        program: Any = partial(_ProgramCompiler, self)
        part: Any = partial(_PartCompiler, self)
        super().__init__(py_func, locals, targetoptions, pipeline_class=program)
        self.part = _Part(py_func, locals, targetoptions, pipeline_class=part)

    def compile(self, sig: Any) -> Any:
        """Compile or load the program for a signature; returns its entry point."""
        if sigutils.normalize_signature(sig)[0] in self.overloads:
            return super().compile(sig)
        with self.alone(sig), global_compiler_lock, resting():
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
