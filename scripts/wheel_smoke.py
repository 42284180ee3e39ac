"""Builds the wheel, installs it alone into a clean environment and uses it far from the sources.

An episode of a controller, then one of the first learned policy that comes with slipgym. With `--sizes` it
prints what installations take on each Python found, with `--list FOLDER` what the wheels and sdists of a
folder hold.
"""

import re
import subprocess
import sys
import tarfile
import tempfile
import venv
import zipfile
from collections import Counter
from pathlib import Path
from time import perf_counter
from typing import Any

from matrix import interpreter

ROOT = Path(__file__).resolve().parents[1]
SHIPPED = ROOT / "policies" / "learned" / "pretrained_policies"
PACKAGES = {"slipgym", "estimator", "policies"}
EPISODE = """
import importlib.util
import pathlib
import sys
import gymnasium as gym
import policies

env = gym.make("slipgym:slipgym/LinearSlip-v0")
policy = policies.make("linear_slip")
observation, info = env.reset(seed=0)
steps, state, over = 0, None, False
while not over:
    action, state = policy.predict(observation, state=state)
    observation, reward, terminated, truncated, info = env.step(action)
    steps, over = steps + 1, terminated or truncated
env.close()
for package in ("estimator", "policies", "slipgym"):
    origin = importlib.util.find_spec(package).origin
    assert pathlib.Path(origin).with_name("py.typed").is_file(), f"{package} is not marked as typed"
assert "torch" not in sys.modules, "the base installation must not load torch"
print(f"one episode: {steps} steps, slip {info['slip']}")
"""
LEARNED = """
import sys
import gymnasium as gym
import policies
from policies.stepping import steps

policy = policies.load(sys.argv[1])
trained = policy.description.environment
env = gym.make(f"slipgym:{trained.id}", **trained.arguments)
policy.check(env)
observation, _ = env.reset(seed=0)
*_, last = steps(env, policy, observation)
env.close()
print(f"{sys.argv[1]}: solved {last.info['is_success']}")
"""


SIZED = {"3.11": ("", "eval", "train"), "3.12": ("", "eval"), "3.13": ("", "eval")}
"""Python -> extras of the table, each with those before it; torch is as large on each."""


def main() -> None:
    """Fails with the first thing that is not as it should be."""
    if sys.argv[1:2] == ["--list"]:
        return list_contents(Path(sys.argv[2]))
    with tempfile.TemporaryDirectory() as folder:
        temporary = Path(folder)
        wheel = build(temporary / "dist")
        check_contents(wheel)
        if "--sizes" in sys.argv[1:]:
            return print_sizes(wheel, temporary, sys.argv[2:] or list(SIZED))
        python = install(wheel, temporary / "venv")
        elsewhere = temporary / "elsewhere"
        elsewhere.mkdir()
        if subprocess.call([python, "-I", "-c", EPISODE], cwd=elsewhere):
            sys.exit("the installed wheel does not run an episode")
        policy = min(path.parent.name for path in SHIPPED.glob("*/policy.json"))
        if subprocess.call([python, "-I", "-c", LEARNED, policy], cwd=elsewhere):
            sys.exit("the installed wheel does not act with a learned policy")


def build(folder: Path) -> Path:
    """Builds the wheel into a folder."""
    subprocess.run([sys.executable, "-m", "build", "--wheel", "--outdir", folder, ROOT], check=True)
    (wheel,) = folder.glob("*.whl")
    return wheel


def check_contents(wheel: Path) -> None:
    """Exactly three packages at top level; every default file, policy and py.typed inside."""
    with zipfile.ZipFile(wheel) as archive:
        files = set(archive.namelist())
    top = {name.split("/")[0] for name in files if ".dist-info/" not in name}
    if top != PACKAGES:
        sys.exit(f"top level of the wheel: {sorted(top)}, wanted {sorted(PACKAGES)}")
    wanted = {f"slipgym/{path.relative_to(ROOT).as_posix()}" for path in (ROOT / "configs").rglob("*.yaml")}
    if not wanted:
        sys.exit("there is no configuration to look for")
    wanted |= {f"{package}/py.typed" for package in PACKAGES}
    wanted |= {path.relative_to(ROOT).as_posix() for path in SHIPPED.rglob("*") if path.is_file()}
    if wanted - files:
        sys.exit(f"missing from the wheel: {sorted(wanted - files)}")
    with zipfile.ZipFile(wheel) as archive:
        (metadata,) = (name for name in files if name.endswith(".dist-info/METADATA"))
        relative = re.findall(r"\]\((?!https?:|#)[^)]*\)", archive.read(metadata).decode())
    if relative:
        sys.exit(f"relative links in the description of the wheel: {relative}")


def list_contents(folder: Path) -> None:
    """Print the size of each wheel and sdist of a folder, and how many files it has of each top level."""
    for path in sorted(folder.iterdir()):
        if path.suffix == ".whl":
            with zipfile.ZipFile(path) as archive:
                names = archive.namelist()
        else:
            with tarfile.open(path) as archive:
                names = [name.partition("/")[2] for name in archive.getnames()]
        counts = Counter(name.split("/")[0] for name in names)
        print(f"{path.name}  {path.stat().st_size / 1e6:.1f} MB")
        print("  " + ", ".join(f"{top} {count}" for top, count in sorted(counts.items())))


def print_sizes(wheel: Path, temporary: Path, versions: list[str]) -> None:
    """Install the rows of SIZED and play a first and a second episode, each in a process of its own."""
    print("| Python | extra | packages | MB | install [s] | first episode [s] | second [s] |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for version in versions:
        if (found := interpreter(version)) is None:
            print(f"| {version} | no such Python here |", flush=True)
            continue
        place = temporary / version
        subprocess.run([found, "-m", "venv", str(place)], check=True)
        python, site = place / "bin" / "python", next(place.glob("lib/*/site-packages"))
        pip = [python, "-m", "pip", "install", "-q", "--no-cache-dir", "-c", ROOT / "constraints.txt"]
        empty = size(place)
        for extra in SIZED[version]:
            took = [seconds([*pip, f"{wheel}[{extra}]" if extra else str(wheel)], place)]
            row = [
                version,
                extra or "-",
                len(list(site.glob("*.dist-info"))),
                round((size(place) - empty) / 1e6),
            ]
            if not extra:
                took += [seconds([python, "-I", "-c", EPISODE], place) for _ in range(2)]
            print("|", *(f"{cell} |" for cell in [*row, *(f"{value:.0f}" for value in took)]), flush=True)


def size(folder: Path) -> int:
    """Bytes of the files in a folder."""
    return sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file())


def seconds(command: list[Any], place: Path) -> float:
    """Run a command in a folder, and return how long it took [s]."""
    start = perf_counter()
    subprocess.run(command, cwd=place, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def install(wheel: Path, folder: Path) -> Path:
    """Installs the wheel with its base dependencies into a new environment and returns its Python."""
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--constraint", ROOT / "constraints.txt"]
    subprocess.run([*pip, wheel], check=True)
    return python


if __name__ == "__main__":
    main()
