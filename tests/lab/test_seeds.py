"""The table of learning from nothing with several seeds."""

import shutil

import numpy as np
import pytest

from lab import seeds
from policies.learned import pretrained
from policies.training import files, folder, run_set
from policies.training.curve import Row
from policies.training.export import POLICY

NAME = "hinge_scratch"


@pytest.fixture
def finished(tmp_path, monkeypatch):
    """A folder with the finished run of seed 1, and no way to train another."""

    def refuse(path, jobs):
        raise AssertionError(f"{path} is trained")

    path = run_set.begin(files.load(NAME), [1], [], tmp_path) / "true__1"
    shutil.copytree(pretrained.locate(NAME), path / POLICY)
    folder.write_curve(path, [Row(0, 0.0, 0.0, 0.0, 0.0), Row(2_000_000, 0.9, 0.0, 0.0, 0.0)])
    folder.write_result(path, {"cpu_seconds": 100.0})
    monkeypatch.setattr(run_set, "train_all", refuse)
    return tmp_path


def test_what_is_finished_or_shipped_is_not_trained_again(finished):
    table = seeds.table([NAME], range(2), finished, 1, 40)
    (row,) = table.to_dict("records")
    assert (row["configuration"], row["seeds"]) == (NAME, 2)
    assert row["solved"] == row["worst seed"] == row["best seed"] > 80.0  # of the same policy twice
    own = seeds.shipped(NAME)[0]
    assert row["million steps"] == pytest.approx(np.mean([2.0, 1e-6 * own.steps]))
    assert row["longest [s]"] == max(100.0, own.cpu_seconds)


def test_a_missing_seed_is_trained(finished):
    with pytest.raises(AssertionError, match="is trained"):
        seeds.table([NAME], range(3), finished, 1, 40)
