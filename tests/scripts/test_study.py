import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def call(folder, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}
    return subprocess.run(
        [sys.executable, ROOT / "scripts" / "study.py", *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_help_teaches(invoke):
    done = invoke("study", "--help")
    assert done.exit_code == 0, done.stderr
    assert "slipgym study full --jobs 2" in done.stdout


def test_an_unknown_study_is_refused_by_name(tmp_path, invoke):
    done = invoke("study", "quik")
    assert done.exit_code == 2
    assert "quick" in done.stderr
    assert list(tmp_path.iterdir()) == []
