"""Consoles that are not UTF-8: every command prints what it has to say, and no character ends it."""

import io
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from policies.commands import front
from policies.play.watch import Outcome

ROOT = Path(__file__).resolve().parents[2]
LOG = ROOT / "examples" / "linear_slip_wood.csv.gz"
SHORT = "--option", "duration=0.2"
ENCODINGS = "ascii", "cp1252", "cp437", "utf-8"


def said(encoding, main, *arguments):
    """Exit status of a command line, and the bytes that arrive at a console of that encoding."""
    held = io.BytesIO()
    console = io.TextIOWrapper(held, encoding, errors="strict", write_through=True)
    with redirect_stdout(console), redirect_stderr(console), pytest.raises(SystemExit) as ended:
        main([*map(str, arguments)])
    console.flush()
    return ended.value.code, held.getvalue()


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("name", [*front.COMMANDS, None])
def test_every_help_is_shown(encoding, name):
    status, words = said(encoding, front.main, *([] if name is None else [name]), "--help")
    assert (status, words.startswith(b"Usage: slipgym")) == (0, True)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_a_name_in_an_error_may_have_any_letters(encoding):
    status, words = said(encoding, front.main, "estimate", "Kraftmessung_µ≥½_日本.csv")
    assert (status, b"Kraftmessung_" in words) == (2, True)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize(
    "words",
    [
        Outcome(0, 1.0, True, False, (0.001, 0.0, 0.5), 3.0).words(),
        "mu_c 0.36 ± 0.01, tilt −2.5°, ≥ 3 μm → wood",
        "日本 and the half of a pair \ud800",
    ],
)
def test_what_a_command_prints_arrives(encoding, words, monkeypatch):
    def app(**_):
        print(words)
        sys.exit(0)

    monkeypatch.setattr(front, "app", app)
    expected = f"{words}{os.linesep}".encode(encoding, "backslashreplace")
    assert said(encoding, front.main) == (0, expected)


@pytest.mark.quick_cases("program0", "program2", "program4")
@pytest.mark.parametrize(
    "program",
    [
        ["-m", "slipgym", "estimate", LOG, "--output", "runs"],
        [ROOT / "scripts" / "estimate.py", LOG, "--output", "runs"],
        [
            "-m",
            "slipgym",
            "play",
            "hold",
            "--video",
            "v.gif",
            "--engine",
            "planar",
            "--option",
            "duration=0.2",
        ],
        ["-m", "slipgym", "record", "hold", "r.csv", "--option", "duration=0.2"],
        [ROOT / "scripts" / "export_policy.py", "no such policy ≥", "--onnx", "p.onnx"],
    ],
)
def test_a_process_with_such_a_console_ends_well(tmp_path, program):
    done = subprocess.run(
        [sys.executable, *map(str, program)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONPATH": str(ROOT)},
        capture_output=True,
    )
    words = done.stdout + done.stderr
    assert done.returncode == (2 if "no such policy ≥" in program else 0), words
    assert b"UnicodeEncodeError" not in words
    assert done.stdout or b"Error: Invalid value" in done.stderr
