"""Builds the wheel, installs it alone into a clean environment and runs an episode far from the sources."""

import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = {"slipgym", "estimator", "policies"}
EPISODE = """
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
assert "torch" not in sys.modules, "the base installation must not load torch"
print(f"one episode: {steps} steps, slip {info['slip']}")
"""


def main() -> None:
    """Fails with the first thing that is not as it should be."""
    with tempfile.TemporaryDirectory() as folder:
        temporary = Path(folder)
        wheel = build(temporary / "dist")
        check_contents(wheel)
        python = install(wheel, temporary / "venv")
        elsewhere = temporary / "elsewhere"
        elsewhere.mkdir()
        if subprocess.call([python, "-I", "-c", EPISODE], cwd=elsewhere):
            sys.exit("the installed wheel does not run an episode")


def build(folder: Path) -> Path:
    """Builds the wheel into a folder."""
    subprocess.run([sys.executable, "-m", "build", "--wheel", "--outdir", folder, ROOT], check=True)
    (wheel,) = folder.glob("*.whl")
    return wheel


def check_contents(wheel: Path) -> None:
    """Exactly the three packages at top level, and every default file inside."""
    with zipfile.ZipFile(wheel) as archive:
        files = set(archive.namelist())
    top = {name.split("/")[0] for name in files if ".dist-info/" not in name}
    if top != PACKAGES:
        sys.exit(f"top level of the wheel: {sorted(top)}, wanted {sorted(PACKAGES)}")
    wanted = {f"slipgym/{path.relative_to(ROOT).as_posix()}" for path in (ROOT / "configs").rglob("*.yaml")}
    if not wanted or wanted - files:
        sys.exit(f"configuration missing from the wheel: {sorted(wanted - files)}")


def install(wheel: Path, folder: Path) -> Path:
    """Installs the wheel with its base dependencies into a new environment and returns its Python."""
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--constraint", ROOT / "constraints.txt"]
    subprocess.run([*pip, wheel], check=True)
    return python


if __name__ == "__main__":
    main()
