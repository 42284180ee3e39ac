"""A stored program is used as long as what is compiled stays the same, and no longer."""

import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import pytest
from numba.core import config

from estimator._numba import caching, folders
from estimator._numba.folders import only_one, program_folder
from slipgym._numba.compiled import compiled

ROOT = Path(__file__).resolve().parents[2]
MAIN = """
import numpy as np
import table
from law import friction, kind_of
from slipgym._numba.compiled import compiled

RATE = 2.0
LEVELS = np.array([0.25, 0.5])

@compiled
def work(x):
    return RATE * friction(x) + table.OFFSET + LEVELS[1] + kind_of(x)

print(work(1.0), sum(work.stats.cache_hits.values()))
"""
LAW = '''
from numba.extending import overload
from slipgym._numba.compiled import compiled

@compiled
def helper(x):
    return 0.0 * x

@compiled
def friction(x, exponent=1.0):
    """Docstring."""
    return 0.5 * x**exponent  # comment

def kind_of(x):
    """Docstring."""

@overload(kind_of)
def _kind_of(x):
    """Docstring."""
    return lambda x: 16.0 + helper(x)
'''
FILES = {"main.py": MAIN, "law.py": LAW, "table.py": "OFFSET = 4.0\n"}
BEFORE = "21.5"


def run(folder: Path, **variables: str) -> list[str]:
    command = [sys.executable, str(folder / "main.py")]
    inherited = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    done = subprocess.run(command, env=inherited | variables, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """A small program, compiled once."""
    folder = tmp_path_factory.mktemp("program")
    for name, text in FILES.items():
        (folder / name).write_text(text)
    assert run(folder) == [BEFORE, "0"]
    return folder


def edited(folder: Path, file: str, old: str, new: str) -> list[str]:
    text = FILES[file]
    assert old in text
    try:
        (folder / file).write_text(text.replace(old, new))
        return run(folder)
    finally:
        (folder / file).write_text(text)


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("law.py", '"""Docstring."""', '"""Another docstring,\n\n    of three lines."""'),
        ("law.py", "# comment", "# another comment"),
        ("law.py", "friction(x, exponent=1.0)", "friction(x: float, exponent: float = 1.0) -> float"),
        ("main.py", "\n\n@compiled", "\n\n\n# lower in the file\n\n@compiled"),
        ("table.py", "OFFSET", "UNUSED = 5.0\nOFFSET"),
    ],
)
@pytest.mark.quick_cases("law.py-# comment-# another comment")
def test_text_that_is_not_compiled_may_change(folder, file, old, new):
    assert edited(folder, file, old, new) == [BEFORE, "1"]


@pytest.mark.parametrize(
    ("file", "old", "new", "value"),
    [
        ("law.py", "0.5 * x**", "1.5 * x**", "23.5"),
        ("law.py", "exponent=1.0", "exponent=1.0, more=1.0", BEFORE),
        ("law.py", "0.0 * x", "1.0 + x", "23.5"),
        ("law.py", "16.0 +", "32.0 +", "37.5"),
        ("main.py", "RATE = 2.0", "RATE = 4.0", "22.5"),
        ("main.py", "0.25, 0.5", "0.25, 1.5", "22.5"),
        ("table.py", "4.0", "5.0", "22.5"),
    ],
)
@pytest.mark.quick_cases("law.py-16.0 +-32.0 +-37.5")
def test_what_is_compiled_may_not_change(folder, file, old, new, value):
    assert edited(folder, file, old, new) == [value, "0"]
    assert run(folder) == [BEFORE, "1"]


def test_a_function_may_move_to_another_module(tmp_path):
    law, main = tmp_path / "law.py", tmp_path / "main.py"
    begin = "from slipgym._numba.compiled import compiled\n@compiled\n"
    law.write_text(begin + "def friction(x):\n    return 0.5 * x\n")
    main.write_text(f"from law import friction\n{begin}def work(x):\n    return friction(x)\n")
    with main.open("a") as file:
        file.write("print(work(1.0), sum(work.stats.cache_hits.values()))\n")
    assert run(tmp_path) == ["0.5", "0"]
    law.rename(tmp_path / "laws.py")
    main.write_text(main.read_text().replace("from law", "from laws"))
    # a program that names the module that is gone cannot be read, which is a warning
    assert run(tmp_path, PYTHONWARNINGS="error") == ["0.5", "0"]
    assert run(tmp_path, PYTHONWARNINGS="error") == ["0.5", "1"]


@pytest.mark.slow
def test_options_and_switches_tell_programs_apart(folder):
    options = "from slipgym._numba.compiled import unlocked as compiled"
    assert edited(folder, "law.py", "from slipgym._numba.compiled import compiled", options)[1] == "0"
    assert run(folder, SLIPGYM_NUMBA_DISABLE="prefetch") == [BEFORE, "0"]
    assert run(folder, SLIPGYM_NUMBA_DISABLE="prefetch") == [BEFORE, "1"]


@pytest.mark.slow
def test_only_the_newest_programs_are_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(caching, "VARIANTS", 3)

    @compiled
    def first(values):
        return values[0]

    for length in range(1, 6):
        first((1.0,) * length)
    assert len(list(tmp_path.rglob("*.nbc"))) == 3
    first.recompile()
    assert sum(first.stats.cache_hits.values()) == 0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="the temporary folder is the user's already")
def test_without_a_writable_folder_programs_are_kept_among_temporary_files(tmp_path, monkeypatch):
    blocked = tmp_path / "a file"
    blocked.touch()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(config, "CACHE_DIR", str(blocked))
    found = program_folder(__file__)
    assert found is not None
    assert found.is_relative_to(tmp_path)
    assert found.parent.stat().st_mode & 0o077 == 0
    found.parent.chmod(0o777)  # others could store a program there
    for cached in (folders._program_folder, folders._warn):
        cached.cache_clear()
    with pytest.warns(UserWarning, match="NUMBA_CACHE_DIR"):
        assert program_folder(__file__) is None
    assert program_folder(folders.__file__) is None  # another warning would be an error here
    folders._program_folder.cache_clear()


def test_processes_that_start_together_compile_once(tmp_path):
    (tmp_path / "law.py").write_text(LAW)
    (tmp_path / "table.py").write_text("OFFSET = 4.0")
    (tmp_path / "main.py").write_text(MAIN)
    with ThreadPoolExecutor(3) as pool:
        done = list(pool.map(run, [tmp_path] * 3))
    assert sorted(done) == [[BEFORE, "0"], [BEFORE, "1"], [BEFORE, "1"]]
    assert not list(tmp_path.rglob("*.lock"))


def test_a_process_that_waits_too_long_goes_on(tmp_path):
    path = tmp_path / "a.lock"
    with only_one(path):
        with only_one(path, patience=0.1):
            assert path.exists()
        assert path.exists()
    assert not path.exists()
    path.touch()  # left by a process that was killed
    with only_one(path, patience=60.0):
        pass


def test_without_a_home_nothing_is_written_to_the_working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(folders.config, "CACHE_DIR", "")
    monkeypatch.setattr(folders, "AppDirs", lambda **_: SimpleNamespace(user_cache_dir="~/.cache/numba"))
    monkeypatch.setattr(folders.tempfile, "gettempdir", lambda: str(tmp_path / "gone"))
    writable = folders._is_writable
    monkeypatch.setattr(
        folders, "_is_writable", lambda folder: folder.name != "__pycache__" and writable(folder)
    )
    for cached in (folders._program_folder, folders._warn):
        cached.cache_clear()
    with pytest.warns(UserWarning, match="NUMBA_CACHE_DIR"):
        assert program_folder(__file__) is None
    folders._program_folder.cache_clear()
    assert list(tmp_path.iterdir()) == []


def test_without_the_compiler_the_import_says_what_to_do():
    done = subprocess.run(
        [sys.executable, "-c", "import estimator; estimator.make('disc')"],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.strip().splitlines()[-1].startswith("ImportError: slipgym and its estimators need")


def test_an_old_numba_is_one_import_error():
    code = "import numba; numba.__version__ = '0.62.1'; import estimator; estimator.make('disc')"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (
        done.stderr.strip()
        .splitlines()[-1]
        .startswith("ImportError: slipgym needs numba>=0.63; numba 0.62.1")
    )


@pytest.mark.slow
@pytest.mark.skipif(
    shutil.which("setpriv") is None or os.geteuid() != 0, reason="only root becomes another user"
)
def test_another_user_on_a_read_only_installation(tmp_path):
    """Without a home and without programs beside the sources: a container's usual state."""
    for name in ("slipgym", "estimator", "policies", "configs"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, tmp_path / "installed" / name, ignore=ignored)
    for folder in (tmp_path, *tmp_path.parents[:2]):
        folder.chmod(0o755)
    code = (
        "import gymnasium as gym, slipgym, tempfile, estimator\n"
        "estimator.make('disc').update(0.0, (0.1, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))\n"
        "env = gym.make('slipgym/LinearSlip-v0', engine='planar')\n"
        "env.reset(seed=0); env.step(env.action_space.sample()); print('fine')"
    )
    # reads what root can, since the interpreter may be root's, and writes what anybody can
    caps = "-all,+dac_read_search"
    nobody = [
        "--reuid=65534",
        "--regid=65534",
        "--clear-groups",
        f"--inh-caps={caps}",
        f"--ambient-caps={caps}",
    ]
    done = subprocess.run(
        ["setpriv", *nobody, sys.executable, "-W", "error::UserWarning:estimator", "-c", code],
        env={"PYTHONPATH": str(tmp_path / "installed"), "PATH": os.environ["PATH"], "OMP_NUM_THREADS": "1"},
        cwd="/",
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.strip() == "fine", done.stderr
    assert not list((tmp_path / "installed").rglob("__pycache__"))
