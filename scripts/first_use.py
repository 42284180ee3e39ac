"""Installs slipgym into an empty environment of every Python found here and times what a new user does.

Each row is a fresh environment with an empty cache of compiled programs: installation from a wheel, the first
episode of README, the first estimate on a log with foreign names and units, the first policy from scratch.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Annotated

import typer
from matrix import PYTHONS, ROOT, interpreter, reason
from wheel_smoke import build

EPISODE = """
import sys
import gymnasium as gym
import policies

engine = "bullet" if sys.version_info < (3, 12) else "planar"
env = gym.make("slipgym:slipgym/LinearSlip-v0", engine=engine)
policy = policies.make("linear_slip")
observation, info = env.reset(seed=0)
state, over = None, False
while not over:
    action, state = policy.predict(observation, state=state)
    observation, reward, terminated, truncated, info = env.step(action)
    over = terminated or truncated
print("solved" if info["is_success"] else "not solved")
"""
LOG = """
import sys
import pandas as pd

log = pd.read_csv(sys.argv[1]).drop(columns=["true_mu_s", "true_mu_c", "true_r"])
log["f_n"] *= -1
log["t"] *= 1e3
for name in ("tau", "tau_x", "tau_y", "v_x", "v_y"):
    log[name] *= 1e3
log["omega"] *= 57.29577951308232
names = {"t": "stamp", "f_x": "Fx", "f_y": "Fy", "f_n": "Fz", "tau": "Mz", "tau_x": "Mx", "tau_y": "My"}
names |= {"v_x": "slip_x", "v_y": "slip_y", "omega": "slip_rate"}
log.rename(columns=names).to_csv("log.csv", index=False)
"""
COLUMNS = ROOT / "examples" / "columns.yaml"
STEPS = (
    ("episode", ["python", "-c", EPISODE]),
    (
        "estimate",
        ["slipgym", "estimate", "log.csv", "--columns", str(COLUMNS)],
    ),
    (
        "policy",
        ["slipgym", "train", "linear_slip_plain", "--set", "stop.success=0.9", "stop.evaluations=1"],
    ),
)
"""Name of a column and its command, run in an empty folder."""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


class Watch:
    """Measures what this program waits for, by the clock and by the processors."""

    def __init__(self) -> None:
        self.begun, self.used = time.perf_counter(), self._used()

    @staticmethod
    def _used() -> float:
        spent = os.times()
        return spent.children_user + spent.children_system

    def said(self) -> str:
        """Such as "67 s (31 s)"."""
        return f"{time.perf_counter() - self.begun:.0f} s ({self._used() - self.used:.0f} s)"


def timed(command: list[str], folder: Path) -> str:
    """Time of a command on an empty cache of its own, or "failed: " and its last line."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    environment["NUMBA_CACHE_DIR"] = tempfile.mkdtemp(dir=folder)
    watch = Watch()
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    spent = watch.said()
    with (folder / "transcript.txt").open("a", encoding="utf-8") as transcript:
        transcript.write(done.stdout + done.stderr)
    return (
        spent if done.returncode == 0 else f"failed: {(done.stderr.strip() or '-').splitlines()[-1].strip()}"
    )


def row(python: str, wheel: Path, folder: Path, steps: list[str]) -> list[str]:
    """Cells of one Python: seconds to install, then of each step; or why not."""
    folder.mkdir(parents=True)
    subprocess.run([python, "-m", "venv", str(folder / "venv")], check=True)
    places = {name: str(folder / "venv" / "bin" / name) for name in ("python", "slipgym")}
    extras = "eval,train" if "policy" in steps else "eval"
    pip = [places["python"], "-m", "pip", "install", "--quiet", "--constraint", str(ROOT / "constraints.txt")]
    watch = Watch()
    done = subprocess.run([*pip, f"{wheel}[{extras}]"], capture_output=True, text=True, check=False)
    if done.returncode:
        return [f"not installed: {reason(done.stdout + done.stderr)}"]
    cells = [watch.said()]
    record = str(ROOT / "examples" / "linear_slip_wood.csv.gz")
    subprocess.run([places["python"], "-c", LOG, record], cwd=folder, check=True)
    for name, command in STEPS:
        if name in steps:
            cells.append(timed([places.get(word, word) for word in command], folder))
    return cells


@app.command()
def main(
    python: Annotated[list[str] | None, typer.Option(help="Versions of Python; none: all.")] = None,
    steps: Annotated[list[str] | None, typer.Option(help="episode, estimate or policy; none: all.")] = None,
    folder: Annotated[Path, typer.Option(help="New folder of environments and transcripts.")] = Path(
        ".venv-first"
    ),
) -> None:
    """Print a table of seconds by the clock and, in brackets, of processor time.

    What the commands said is in transcript.txt of each folder.
    """
    wanted = [name for name, _ in STEPS if not steps or name in steps]
    unknown = sorted(set(steps or ()) - set(wanted))
    if unknown:
        raise typer.BadParameter(f"unknown steps {unknown}; valid: {[name for name, _ in STEPS]}")
    if folder.exists():
        raise typer.BadParameter(f"{folder} exists; name a new folder, or remove it")
    folder = folder.absolute()
    wheel = build(folder / "dist")
    lines = [f"| Python | installation | {' | '.join(wanted)} |", "| --- |" + " ---: |" * (len(wanted) + 1)]
    for version in python or PYTHONS:
        found = interpreter(version)
        cells = row(found, wheel, folder / version, wanted) if found else ["no such Python here"]
        lines.append(f"| {version} | {' | '.join(cells)} |")
        typer.echo(lines[-1], err=True)
    typer.echo("\n".join(lines))


if __name__ == "__main__":
    sys.exit(app())
