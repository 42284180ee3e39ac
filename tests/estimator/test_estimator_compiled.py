"""The cache of compiled kernels notices a change in a function of another file."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import estimator

CALL = """
import estimator
est = estimator.make("rls")
for k in range(3):
    e = est.update(k, (2.0, 0.0, 5.0, 0.0), (0.02, 0.0, 0.0))
print(e.gamma_t)
"""


@pytest.mark.slow
def test_an_edited_shared_function_is_compiled_again(tmp_path):
    copy = tmp_path / "estimator"
    shutil.copytree(Path(estimator.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))

    def gamma_t() -> float:
        done = subprocess.run(
            [sys.executable, "-c", CALL], cwd=tmp_path, capture_output=True, text=True, check=True
        )
        return float(done.stdout.split()[-1])

    before = gamma_t()
    assert before == gamma_t() == 1.0
    kernel = copy / "sample.py"  # called from rls.py
    law = kernel.read_text()
    assert "return min(translation * scale, 1.0)," in law
    kernel.write_text(
        law.replace("return min(translation * scale, 1.0),", "return 0.5 * translation * scale,")
    )
    assert gamma_t() == pytest.approx(0.5 * before)


@pytest.mark.slow  # quick: tests/house/test_program_cache.py
def test_a_touched_file_with_the_same_contents_keeps_the_cache(tmp_path, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    copy = tmp_path / "estimator"
    shutil.copytree(Path(estimator.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))

    def kernels() -> dict[Path, int]:
        subprocess.run([sys.executable, "-c", CALL], cwd=tmp_path, capture_output=True, check=True)
        return {path: path.stat().st_mtime_ns for path in copy.rglob("*.nbc")}

    before = kernels()
    assert before
    (copy / "sample.py").touch()
    assert kernels() == before
