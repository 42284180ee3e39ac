"""What an installation takes: pip runs in a new environment, and what it adds is counted."""

import sys
import zipfile

import pandas as pd
import pytest
from typer.testing import CliRunner

from lab import install_sizes
from lab.commands.install_sizes import app
from lab.install_sizes import Installation

METADATA = {
    "METADATA": "Metadata-Version: 2.1\nName: package\nVersion: 1\n",
    "WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    "RECORD": "",
}


def test_size_counts_files_and_no_links(tmp_path):
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "file").write_bytes(bytes(3000))
    (tmp_path / "link").symlink_to(tmp_path / "inner" / "file")
    assert install_sizes.size(tmp_path) == pytest.approx(0.003)


@pytest.mark.slow(reason="makes a virtual environment")
def test_only_what_pip_adds_counts(tmp_path):
    package = tmp_path / "package-1-py3-none-any.whl"
    with zipfile.ZipFile(package, "w") as wheel:
        wheel.writestr("package.py", "#" * 2_000_000)
        for name, text in METADATA.items():
            wheel.writestr(f"package-1.dist-info/{name}", text)
    found = install_sizes.installed(sys.executable, ["--no-index", "--no-compile", str(package)])
    assert found.size == pytest.approx(2.0, abs=0.05)
    assert found.time > 0.0


def test_a_row_for_each_extra_a_column_for_each_python(monkeypatch):
    def installed(python, arguments):
        extra = arguments[-1].removeprefix(str(install_sizes.ROOT))
        return Installation(size=100.0 * len(extra), time=float(python[-1]))

    monkeypatch.setattr(install_sizes, "installed", installed)
    found = install_sizes.table(["python1", "python2"], ["", "cli"])
    expected = {
        "extra": ["none", "cli"],
        "python1 [MB]": [0.0, 500.0],
        "python1 [s]": [1.0, 1.0],
        "python2 [MB]": [0.0, 500.0],
        "python2 [s]": [2.0, 2.0],
    }
    pd.testing.assert_frame_equal(found, pd.DataFrame(expected))


def test_an_interpreter_that_is_missing_is_named():
    result = CliRunner().invoke(app, ["--python", "python9"])
    assert result.exit_code == 2
    assert "python9" in result.output
