"""Runs tests with every Python and several versions of the dependencies found here; prints a table."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Annotated

import typer

ROOT = Path(__file__).resolve().parents[1]
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
TESTS = (
    "tests/house",
    "tests/config",
    "tests/envs/test_state.py",
    "tests/envs/test_episode.py",
    "tests/estimator",
)
"""What each row runs unless other tests are named."""
EXTRAS = ("eval", "study")
"""Extras of slipgym that each row installs."""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


def oldest() -> list[str]:
    """Requirements of the lower bounds in pyproject.toml, those of the tested extras included."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    groups = [project["dependencies"], *(project["optional-dependencies"][name] for name in EXTRAS)]
    bounds = [re.match(r"([\w-]+)>=([\d.]+)", requirement) for group in groups for requirement in group]
    return [f"{bound[1]}=={bound[2]}" for bound in bounds if bound]


SETS = {
    "pinned": ["--constraint", str(ROOT / "constraints.txt")],
    "newest": [],
    "oldest": oldest(),
    "gymnasium 1.2": ["gymnasium==1.2.*"],
    "gymnasium 1.4": ["gymnasium==1.4.*"],
}
"""Name -> further arguments of pip."""


def interpreter(version: str) -> str | None:
    """Path of a Python of a version that starts here; None if there is none."""
    places = [shutil.which(f"python{version}")]
    places += [str(path) for path in Path.home().glob(f".pyenv/versions/{version}*/bin/python{version}")]
    for place in filter(None, places):
        done = subprocess.run([place, "-c", "import venv, ensurepip"], capture_output=True, check=False)
        if done.returncode == 0:
            return place
    return None


def reason(said: str) -> str:
    """Why pip did not install something, in a few words."""
    missing = re.search(r"The conflict is caused by:\s+\S+ \S+ depends on ([\w.-]+)", said)
    if missing:
        return f"no wheel of {missing[1]} that fits"
    faults = [line[7:] for line in said.splitlines() if line.startswith("ERROR: ")]
    return faults[0][:100] if faults else "see pip"


def row(python: str, requirements: list[str], folder: Path, tests: list[str]) -> str:
    """Install and test one combination; what came of it, in a few words."""
    run = folder / "bin" / "python"
    if not run.exists():
        subprocess.run([python, "-m", "venv", str(folder)], check=True)
    wanted = [f"{ROOT}[{','.join(EXTRAS)}]", "pytest", "hypothesis", "psutil", "filterpy"]
    install = [str(run), "-m", "pip", "install", "--only-binary", ":all:", "--no-binary", "filterpy"]
    done = subprocess.run([*install, *wanted, *requirements], capture_output=True, text=True, check=False)
    if done.returncode:
        return f"not installed: {reason(done.stdout + done.stderr)}"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    command = [str(run), "-m", "pytest", "-q", "-m", "not slow", "-p", "no:cacheprovider", *tests]
    done = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, errors="replace", check=False
    )
    (folder / "tests.log").write_text(done.stdout + done.stderr, encoding="utf-8")
    lines = done.stdout.strip().splitlines() or ["no output"]
    return lines[-1].strip("= ")


@app.command()
def main(
    python: Annotated[list[str] | None, typer.Option(help="Versions of Python; none: all.")] = None,
    dependencies: Annotated[list[str] | None, typer.Option(help=f"Of {', '.join(SETS)}; none: all.")] = None,
    tests: Annotated[list[str] | None, typer.Option(help="Files of tests; none: a selection.")] = None,
    folder: Annotated[Path, typer.Option(help="Folder of the environments.")] = Path(".venv-matrix"),
) -> None:
    """Print what came of every combination, and which could not be tried."""
    lines = ["| Python | dependencies | outcome |", "| --- | --- | --- |"]
    for version in python or PYTHONS:
        found = interpreter(version)
        for name in dependencies or SETS:
            if name not in SETS:
                raise typer.BadParameter(f"unknown dependencies {name!r}; valid: {', '.join(SETS)}")
            place = (folder / f"{version}-{name.replace(' ', '-')}").absolute()
            outcome = row(found, SETS[name], place, tests or list(TESTS)) if found else "no such Python here"
            lines.append(f"| {version} | {name} | {outcome} |")
            typer.echo(lines[-1], err=True)
    typer.echo("\n".join(lines))


if __name__ == "__main__":
    sys.exit(app())
