"""The workloads of the benchmark: what they print, and that each is what it is called."""

import pytest

from lab.benchmarking.workloads import workloads
from policies.learned import pretrained


@pytest.mark.slow
@pytest.mark.parametrize("env_id", ["slipgym/RotationalSlip-v0", "slipgym/Hinge-v0"])
def test_every_workload_is_measured(env_id):
    figures = {figure.name: figure.value for figure in workloads(env_id, blocks=1, size=64, steps=60)}
    shares = {name: value for name, value in figures.items() if name.endswith("slipping rows")}
    assert len(figures) == 10
    assert len(shares) == 5
    firm, limit = (next(v for n, v in shares.items() if w in n) for w in ("held firmly", "slip limit"))
    assert firm < 0.02
    assert limit > 0.25
    assert all(value > 0.0 for name, value in figures.items() if name not in shares)


def test_a_task_without_a_learned_policy_is_measured_with_its_controller(monkeypatch, tmp_path):
    monkeypatch.setattr(pretrained, "FOLDER", tmp_path)
    names = [figure.name for figure in workloads("slipgym/FragileHold-v0", blocks=1, size=8, steps=2)]
    assert [name.split(", ")[1].split(":")[0] for name in names[::2]] == [
        "held firmly",
        "about the slip limit",
        "all forces",
        "controller fragile_hold",
    ]
