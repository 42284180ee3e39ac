"""Damaged checkpoints, a second process, a full disk and a folder that vanishes."""

import errno
import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from policies.training import checkpoints, folder, run
from policies.training.folder import only_process
from slipgym import atomic_io

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def ended(small, tmp_path_factory):
    """The folder of a run that has ended."""
    path = tmp_path_factory.mktemp("runs") / "run"
    folder.begin(path, small(budget=64), 0)
    run.train(path, progress=False)
    return path


@pytest.fixture
def unfinished(ended, tmp_path):
    """A run whose last step, the export of its policy, is missing."""
    path = tmp_path / "run"
    shutil.copytree(ended, path)
    (path / "result.json").unlink()
    shutil.rmtree(path / "policy")
    return path


def flip(path: Path) -> None:
    """Flip a bit in the data of the largest member; names and times in a zip do not matter."""
    with zipfile.ZipFile(path) as archive:
        member = max(archive.infolist(), key=lambda info: info.file_size)
    content = bytearray(path.read_bytes())
    content[member.header_offset + 30 + len(member.filename) + member.file_size // 2] ^= 1
    path.write_bytes(content)


def test_a_flipped_byte_in_the_best_checkpoint_does_not_stop_a_run(unfinished):
    flip(checkpoints.best(unfinished))
    with pytest.warns(UserWarning, match=r"best\.checkpoint is damaged.*that of the last checkpoint"):
        result = run.train(unfinished, progress=False)
    assert result["best"]["steps"] == folder.read_curve(unfinished)[-1].steps
    assert (unfinished / "policy" / "weights.safetensors").is_file()


def test_with_all_of_them_damaged_the_run_says_so(unfinished):
    for path in checkpoints.folder(unfinished).iterdir():
        flip(path)
    with pytest.raises(ValueError, match="is damaged"):
        run.train(unfinished, progress=False)


def crafted(state, path, value) -> None:
    *groups, last = path.split(".")
    for group in groups:
        state = state[int(group)] if isinstance(state, list) else state[group]
    if isinstance(state, list):
        state[int(last)] = value
    else:
        state[last] = value


CRAFTED = {
    "learner": None,
    "learner.counters": {"num_timesteps": "many"},
    "learner.counters.num_timesteps": None,
    "learner.last._last_obs": np.zeros((1, 1), np.float32),
    "learner.parameters": {},
    "learner.normalisation.observations.var": np.array(["a"]),
    "learner.normalisation.running": np.zeros(1),
    "learner.generators.numpy": ("MT19937", np.zeros(3, np.uint32), 0, 0, 0.0),
    "learner.parameters.policy": {"a": {"tensor": np.full(3, np.nan)}},
    "learner.generators.torch": np.zeros(3, np.uint8),
    "learner.generators.python": (3, (1, 2), None),
    "learner.generators.actions": {"bit_generator": "PCG64", "state": 3},
    "learner.environments.envs": [None],
    "learner.environments.returns": np.zeros(99),
    "record": {},
    "record.curve": [{"steps": 1}],
    "record.next": [1],
}


@pytest.mark.parametrize("path", CRAFTED)
def test_a_checkpoint_of_another_shape_with_right_checksums(unfinished, path):
    for checkpoint in checkpoints.kept(unfinished):
        state = checkpoints.read(checkpoint)
        crafted(state, path, CRAFTED[path])
        checkpoints.write(checkpoint, state)
    with pytest.raises(ValueError, match="the last checkpoint"):
        run.train(unfinished, progress=False)


def test_states_of_environments_inside_are_checked(unfinished):
    for checkpoint in checkpoints.kept(unfinished):
        state = checkpoints.read(checkpoint)
        for one in state["learner"]["environments"]["envs"]:
            one.simulation.plant.fingers["queued"][:] = 2**62
        checkpoints.write(checkpoint, state)
    with pytest.raises(ValueError, match=r"the last checkpoint .*plant\.fingers is not as"):
        run.train(unfinished, progress=False)


def test_parts_of_an_archive_do_not_overlap(tmp_path):
    path = tmp_path / "bomb.checkpoint"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("tree.json", json.dumps({"list": []}) + " " * 100_000)
        (entry,) = archive.infolist()
        for k in range(50):
            other = zipfile.ZipInfo(f"{k}.npy")
            for name in ("header_offset", "file_size", "compress_size", "CRC"):
                setattr(other, name, getattr(entry, name))
            archive.filelist.append(other)
    with pytest.raises(ValueError, match="is damaged"):
        checkpoints.read(path)


def test_a_pipe_is_no_checkpoint(tmp_path):
    os.mkfifo(tmp_path / "pipe.checkpoint")
    with pytest.raises(ValueError, match="is no regular file"):
        checkpoints.read(tmp_path / "pipe.checkpoint")


def test_a_second_process_is_kept_out(unfinished):
    with only_process(unfinished), pytest.raises(ValueError, match="another process trains this run"):
        run.train(unfinished, progress=False)
    run.train(unfinished, progress=False)


def resume(path: Path) -> subprocess.CompletedProcess[str]:
    """`scripts/train.py --resume`, after which the disk is full or the folder is gone."""
    script = (
        "import sys, runpy; from slipgym import atomic_io\n"
        "def write(path, data): raise OSError(28, 'No space left on device', str(path))\n"
        "atomic_io.write = write\n"
        "sys.argv = ['train.py', '--resume', sys.argv[1]]\n"
        "runpy.run_path('scripts/train.py', run_name='__main__')"
    )
    return subprocess.run(
        [sys.executable, "-c", script, str(path)],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_a_full_disk_is_one_sentence(unfinished):
    done = resume(unfinished)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert done.stderr.strip().splitlines()[-1].startswith("error: [Errno 28] No space left on device")


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "file"
    atomic_io.write(path, b"old")

    def full(_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        atomic_io.write(path, b"new")
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]
