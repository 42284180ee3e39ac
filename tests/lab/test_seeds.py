"""The table of learning from nothing with several seeds."""

import shutil

import pytest

from lab import seeds
from policies.learned import pretrained
from policies.training import files, folder, run_set
from policies.training.curve import Row
from policies.training.export import POLICY

NAME = "hinge_scratch"


@pytest.fixture
def finished(tmp_path, monkeypatch):
    """A folder with the finished runs of seeds 0 and 1, and no way to train another."""

    def refuse(path, jobs):
        raise AssertionError(f"{path} is trained")

    study = run_set.begin(files.load(NAME), [0, 1], [], tmp_path)
    for seed in (0, 1):
        path = study / f"true__{seed}"
        shutil.copytree(pretrained.locate(NAME), path / POLICY)
        steps = 1_000_000 * (1 + seed)
        folder.write_curve(path, [Row(0, 0.0, 0.0, 0.0, 0.0), Row(steps, 0.9, 0.0, 0.0, 0.0)])
        folder.write_result(path, {"cpu_seconds": 100.0 * (1 + seed)})
    monkeypatch.setattr(run_set, "train_all", refuse)
    return tmp_path


def test_what_is_finished_is_not_trained_again(finished):
    table = seeds.table([NAME], range(2), finished, 1, 40)
    (row,) = table.to_dict("records")
    assert (row["configuration"], row["seeds"]) == (NAME, 2)
    assert row["solved"] == row["worst seed"] == row["best seed"] > 80.0  # of the same policy twice
    assert (row["million steps"], row["longest [s]"]) == (1.5, 200.0)


def test_a_missing_seed_is_trained(finished):
    with pytest.raises(AssertionError, match="is trained"):
        seeds.table([NAME], range(3), finished, 1, 40)


def test_a_run_of_another_configuration_is_no_seed(finished, monkeypatch):
    today = files.load(NAME)
    monkeypatch.setattr(files, "load", lambda name: today.model_copy(update={"num_envs": 2}))
    with pytest.raises(AssertionError, match="is trained"):
        seeds.table([NAME], range(2), finished, 1, 40)
