"""A stored program is used only if it is whole, is the one that is asked for, and is the user's own."""

import os
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
from numba import types
from numba.core import config

from estimator._numba import caching, folders, program_file
from estimator._numba.caching import compiler

F = types.float64
ROOT = Path(__file__).resolve().parents[2]


def law(constant):
    """Functions of one name and one type."""

    def friction(x):
        return constant * x

    return compiler()(friction)


@pytest.fixture
def store(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(caching, "_DEFINED", {})
    caching._warn_unusable.cache_clear()
    folders._program_folder.cache_clear()
    yield tmp_path
    folders._program_folder.cache_clear()


def stored(constant):
    """The file of a program that has just been compiled."""
    function = law(constant)
    assert function(2.0) == 2.0 * constant
    path = function._cache._path((F,), function.targetctx.codegen())
    assert path.is_file()
    return path


def hits(constant):
    function = law(constant)
    assert function(2.0) == 2.0 * constant
    return sum(function.stats.cache_hits.values())


def test_programs_of_equal_names_and_other_constants_have_other_symbols(store):
    first, second = law(2.0), law(3.0)
    assert (first(1.0), second(1.0)) == (2.0, 3.0)
    names = [f.overloads[(F,)].fndesc.llvm_func_name for f in (first, second)]
    assert len({*names}) == 2


APART = """
import sys
from numba import types
from estimator._numba.caching import compiler, njit

def law(constant):
    @njit
    def part(x):
        return constant * max(x, 1)
    def friction(x):
        return part(x) + part(x + 1.0)
    return compiler()(friction)

for constant in map(float, sys.argv[1:]):
    friction = law(constant)
    print(friction(2.0), sum(friction.stats.cache_hits.values()))
"""


def test_programs_that_were_compiled_in_different_processes_do_not_mix(tmp_path):
    (tmp_path / "main.py").write_text(APART)

    def run(*constants):
        command = [sys.executable, str(tmp_path / "main.py"), *constants]
        paths = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
        return subprocess.run(command, env=paths, capture_output=True, text=True, check=True).stdout.split()

    assert run("2") == ["10.0", "0"]
    assert run("3") == ["15.0", "0"]
    assert run("2", "3") == ["10.0", "1", "15.0", "1"]
    assert run("3", "2") == ["15.0", "1", "10.0", "1"]


def test_a_program_shows_its_entry_points_only(store):
    """Two programs may hold different parts of one name."""
    function = law(5.0)
    function(1.0)
    module = function.overloads[(F,)].library._final_module
    visible = {f.name for f in module.functions if not f.is_declaration and f.linkage.name != "internal"}
    descriptor = function.overloads[(F,)].fndesc
    assert visible == {*caching._symbols(descriptor)}


def flip(path, at):
    data = bytearray(path.read_bytes())
    data[at] ^= 0x10
    path.write_bytes(data)


@pytest.mark.parametrize("at", [0, 20, 100, 200, 1000, -1])
def test_a_flipped_bit_is_noticed(store, at):
    flip(stored(2.0), at)
    with pytest.warns(UserWarning, match="compiled again"):
        assert hits(2.0) == 0
    assert hits(2.0) == 1


@pytest.mark.parametrize("content", [b"", b"slipgym program 5\n", b"\x80\x04N.", b"x" * 5000])
def test_another_content_is_noticed(store, content):
    path = stored(2.0)
    path.write_bytes(content)
    with pytest.warns(UserWarning, match="no program file of this version"):
        assert hits(2.0) == 0


def test_a_description_that_cannot_be_read_is_noticed(store, monkeypatch):
    path = stored(2.0)
    function = law(2.0)
    key = next(function._cache._candidates((F,), function.targetctx.codegen()))[1]
    monkeypatch.setattr(program_file, "dumps", lambda _: b"no pickle")
    program_file.write(path, key, b"", None)
    with pytest.warns(UserWarning, match="UnpicklingError"):
        assert hits(2.0) == 0


def test_a_program_under_another_ones_name_is_refused(store):
    two, three = stored(2.0), stored(3.0)
    shutil.copy(two, three)
    with pytest.warns(UserWarning, match="it holds another program"):
        assert hits(3.0) == 0


def test_a_symbol_is_defined_once(store):
    stored(2.0)
    caching._DEFINED.update(dict.fromkeys(caching._DEFINED, ("another program", "")))
    with pytest.warns(UserWarning, match="another program defines"):
        assert hits(2.0) == 0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="files have no owner here")
@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda path: path.chmod(0o666), "others can write"),
        (lambda path: path.chmod(0o664), "others can write"),
        pytest.param(
            lambda path: os.chown(path, 1234, 1234),
            "belongs to another user, number 1234",
            marks=pytest.mark.skipif(os.geteuid() != 0, reason="only root gives a file away"),
        ),
    ],
)
def test_a_program_of_another_user_is_not_loaded(store, change, reason):
    change(stored(2.0))
    with pytest.warns(UserWarning, match=reason):
        assert hits(2.0) == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error", ResourceWarning)
        assert hits(2.0) == 1


@pytest.mark.skipif(not hasattr(os, "getuid") or os.geteuid() != 0, reason="only root gives a folder away")
def test_a_cache_folder_of_another_user_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    source = tmp_path / "law.py"
    source.touch()
    (tmp_path / "__pycache__").mkdir()
    os.chown(tmp_path / "__pycache__", 1234, 1234)
    found = folders.program_folder(str(source))
    assert found is not None
    assert found != tmp_path / "__pycache__"


def test_folders_of_a_package_do_not_depend_on_where_it_is():
    assert folders.place(ROOT / "slipgym" / "envs") == Path("slipgym/envs")
    assert folders.place(ROOT / "tests").name.startswith("tests_")


def test_programs_that_come_with_the_installation_are_loaded(store, monkeypatch):
    if not folders.runs_shipped():
        pytest.skip("this processor does not run them")
    function = law(2.0)
    code = function.targetctx.codegen()
    triple = code.magic_tuple()[0]
    monkeypatch.setattr(type(code), "magic_tuple", lambda _: (triple, folders.TARGET, ""))
    path = stored(2.0)
    monkeypatch.undo()
    shipped = store / "shipped"
    monkeypatch.setattr(folders, "SHIPPED", shipped)
    target = shipped / folders.place(Path(__file__).parent) / path.name
    target.parent.mkdir(parents=True)
    path.rename(target)
    monkeypatch.setattr(config, "CACHE_DIR", str(store / "empty"))
    folders._program_folder.cache_clear()
    assert hits(2.0) == 1
    monkeypatch.setattr(folders, "runs_shipped", lambda: False)
    assert hits(2.0) == 0
    (shipped / folders.ABOUT).write_text('{"python": "cpython-311", "numba": "0.1", "llvmlite": "0.1"}')
    assert "AVX2".lower() in folders.why_compiling()
    monkeypatch.setattr(folders, "runs_shipped", lambda: True)
    assert "numba 0.1" in folders.why_compiling()
