"""Writes requirements-ci.txt: what the tests install, with the hash of every file, from constraints.txt."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCKED = ROOT / "requirements-ci.txt"
HEAD = """\
# What CI installs on Linux with Python {}.{}, with hashes; python scripts/lock.py writes it anew.
# torch is left out: its file depends on the accelerator.
#   pip install --require-hashes --no-deps -r requirements-ci.txt
#   pip install --no-deps --no-build-isolation -e .
"""


def main() -> None:
    """Ask pip what it would install, and write the versions with their hashes."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed"]
        command += ["--report", str(report), "--constraint", "constraints.txt", ".[dev,train]"]
        command += ["hatchling", "hatch-fancy-pypi-readme"]
        subprocess.run(command, cwd=ROOT, check=True)
        found = json.loads(report.read_text(encoding="utf-8"))["install"]
    lines = []
    for item in found:
        name, version = item["metadata"]["name"].lower(), item["metadata"]["version"]
        hashes = item["download_info"].get("archive_info", {}).get("hashes", {})
        if name != "slipgym" and "+" not in version:  # torch's file depends on the accelerator
            lines.append(f"{name}=={version} --hash=sha256:{hashes['sha256']}")
    LOCKED.write_text(HEAD.format(*sys.version_info[:2]) + "\n".join(sorted(lines)) + "\n", encoding="utf-8")
    print(f"{len(lines)} packages in {LOCKED.name}")


if __name__ == "__main__":
    main()
