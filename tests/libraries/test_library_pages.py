"""The examples of docs/libraries/ run as they are, the commands of docs/first_policy.md in small."""

import os
import re
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
SLIPGYM = [sys.executable, "-m", "slipgym"]
PAGES = {
    "ppo": ("torch",),
    "skrl": ("torch", "skrl"),
    "torchrl": ("torch", "torchrl"),
    "rllib": ("torch", "ray.rllib"),
    "minari": ("minari", "jax", "h5py", "torch"),
}
"""Page -> what its example imports besides slipgym; test-only where it is installed."""


def example(page):
    """The file that a page shows."""
    text = (ROOT / "docs" / "libraries" / f"{page}.md").read_text(encoding="utf-8")
    (path,) = re.findall(r"^<!-- code: (\S+) -->$", text, re.MULTILINE)
    assert f"](../../{path})" in text
    return (ROOT / path).read_text(encoding="utf-8")


def called(command, folder, **more):
    """What a command prints, in a folder of its own."""
    paths = [str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **more}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=600
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def run(page, folder, *arguments):
    """What the example of a page prints; skipped where its libraries are missing or refuse this Gymnasium."""
    for library in PAGES[page]:
        pytest.importorskip(library, exc_type=ImportError)
    if page == "rllib" and not gymnasium.__version__.startswith("1.2."):
        pytest.skip(f"RLlib wants Gymnasium 1.2.2, here is {gymnasium.__version__}")
    (folder / "train.py").write_text(example(page), encoding="utf-8")
    home = {
        "HOME": str(folder),
        "MINARI_DATASETS_PATH": str(folder / "datasets"),
    }  # Ray keeps a token at home
    return called([sys.executable, "train.py", *map(str, arguments)], folder, **home)


def returns(printed):
    found = re.findall(r"^ *\d+ steps: return +(-?[\d.]+)", printed, re.MULTILINE)
    return [float(value) for value in found]


@pytest.mark.parametrize("page", PAGES)
def test_an_example_is_short_and_is_the_only_one_of_its_page(page):
    code = example(page)
    compile(code, page, "exec")
    assert len(code.splitlines()) <= 100
    assert set(PAGES) == {path.stem for path in (ROOT / "docs" / "libraries").glob("*.md")}
    assert len(PAGES) == len(list((ROOT / "examples" / "libraries").glob("*.py")))


@pytest.mark.slow
@pytest.mark.parametrize("page", ["ppo", "skrl", "torchrl", "rllib"])
def test_it_learns(page, tmp_path):
    found = returns(run(page, tmp_path, 50_000))
    assert len(found) >= 5
    assert found[-1] > max(0.0, found[0])


@pytest.mark.slow
def test_the_single_file_takes_another_task(tmp_path):
    assert returns(run("ppo", tmp_path, 20_000, "Hold"))


@pytest.mark.slow
def test_a_clone_learns_from_demonstrations(tmp_path):
    for library in PAGES["minari"]:
        pytest.importorskip(library)
    home, name = {"MINARI_DATASETS_PATH": str(tmp_path / "datasets")}, "slipgym/fragile_hold/learned-v0"
    stored = called(
        [*SLIPGYM, "demonstrate", "fragile_hold_scratch", name, "--episodes", "60"], tmp_path, **home
    )
    assert re.fullmatch(rf"{name}: 60 episodes, \d+ steps, (5\d|60) solved\n", stored)
    printed = run("minari", tmp_path, name, 30)
    (solved,) = re.findall(r"the clone solves (\d+) of 100", printed)
    assert int(solved) > 60


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # Minari's temporary folder
def test_a_demonstration_repeats_itself_bit_for_bit(tmp_path, monkeypatch):
    minari = pytest.importorskip("minari")
    pytest.importorskip("h5py")
    from policies.evaluation.one_policy import demonstrate

    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    stored = demonstrate("hold", "hold-v0", 2, first=5, changes={"engine": "planar"})
    assert (stored.episodes, stored.solved) == (2, 2)
    dataset = minari.load_dataset("hold-v0")
    again = dataset.recover_environment()
    for number, episode in enumerate(dataset.iterate_episodes()):
        first, _ = again.reset(seed=5 + number)
        np.testing.assert_array_equal(first, episode.observations[0])
        for action, expected in zip(episode.actions, episode.observations[1:], strict=True):
            np.testing.assert_array_equal(again.step(action)[0], expected)
    again.close()
    with pytest.raises(FileExistsError, match="hold-v0"):
        demonstrate("hold", "hold-v0", 1)
    with pytest.raises(ValueError, match="bad name"):
        demonstrate("hold", "bad name", 1)


@pytest.mark.slow
def test_the_first_policy(tmp_path):
    """Its commands, with a small budget."""
    pytest.importorskip("stable_baselines3")
    page = (ROOT / "docs" / "first_policy.md").read_text(encoding="utf-8")
    (train,) = re.findall(r"^    slipgym train (\w+ --set stop.*)$", page, re.MULTILINE)
    small = ["budget=64", "ppo.n_steps=2", "ppo.batch_size=16", "evaluation.episodes=2"]
    called([sys.executable, "-m", "slipgym", "train", *train.split(), *small], tmp_path)
    (policy,) = tmp_path.glob("runs/*/estimated__0/policy")
    commands = re.findall(r"^    slipgym evaluate --policy (.*)$", page, re.MULTILINE)
    assert len(commands) == 3
    for command in commands:
        which, *rest = command.split()
        which = str(policy) if which.endswith("/policy") else which
        evaluate = [sys.executable, "-m", "slipgym", "evaluate", "--policy", which, "--trials", "1", *rest]
        assert "of 1, dropped" in called(evaluate, tmp_path)
