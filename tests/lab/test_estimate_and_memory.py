"""What an estimate adds to a memory: the trainings of both conditions and their table."""

import numpy as np
import pytest

from lab import estimate_and_memory as measured
from policies.training import folder, run
from policies.training.curve import Row

IMITATION = """
environment:
  friction_source: none
  frame_skip: 2
  level: hard
  randomization: none
  action_mode: log_grip_force
  load_columns: true
teacher: revealed
memory: 4
layers: [4]
rounds: 1
rows: 4
updates: 1
batch: 2
held_out: 0
"""
TRAINING = """
task: Hold
algorithm: privileged_ppo
budget: 32
num_envs: 4
environment:
  friction_source: none
  frame_skip: 2
  level: hard
  randomization: none
  action_mode: log_grip_force
  load_columns: true
  estimator: null
evaluation: {every: 32, episodes: 4}
checkpoints: {every: 32, keep: 1}
privileged_ppo: {memory: 4, net_arch: [4], n_steps: 8, n_minibatches: 2}
"""


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    """Folder of the runs; trainings of a few steps, evaluated where they were trained."""
    for name, text in (("NETWORK", IMITATION), ("TRAINING", TRAINING)):
        path = tmp_path / f"{name}.yaml"
        path.write_text(text)
        monkeypatch.setattr(measured, name, str(path))
    monkeypatch.setattr(measured, "WORLDS", {"itself": {}})
    return tmp_path / "runs"


@pytest.mark.slow
def test_both_conditions_are_trained_alike_and_once(tiny, monkeypatch):
    table = measured.table([0, 1], tiny, 1, 4)
    assert table["observes"].tolist() == [measured.WITHOUT, measured.WITH, "added by the estimate"]
    assert table["seeds"].tolist() == [2, 2, 2]
    without, given = (
        folder.order(tiny / name / "trained_1")[0] for name in ("memory", "memory_and_estimate")
    )
    assert without.environment.estimator is None
    assert (given.environment.estimator, given.environment.friction_source) == ("adaptive", "estimated")
    assert without.privileged_ppo.model_dump(exclude={"start"}) == given.privileged_ppo.model_dump(
        exclude={"start"}
    )
    monkeypatch.setattr(run, "_train", None)  # nothing is trained again
    assert measured.table([0, 1], tiny, 1, 4).equals(table)


def test_steps_are_those_to_the_first_evaluation_with_the_aim(tmp_path):
    shares = 0.2, measured.AIM - 0.01, measured.AIM, 0.3
    folder.write_curve(tmp_path, [Row(k, share, 0.0, 0.0, 0.0) for k, share in enumerate(shares)])
    assert (measured.first(tmp_path), measured.reached(tmp_path)) == (20.0, 2)
    folder.write_curve(tmp_path, [Row(0, 0.2, 0.0, 0.0, 0.0)])
    assert measured.reached(tmp_path) == np.inf
