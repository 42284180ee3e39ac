"""An environment's id comes from its task, so that a second version drops out of nothing."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

import policies
from policies.evaluation.one_policy import environment_of
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import TASKS, find

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def second_version(monkeypatch):
    """Hold as slipgym/Hold-v1, in place of its first version."""
    task = replace(TASKS["Hold"], id="slipgym/Hold-v1")
    monkeypatch.setitem(TASKS, "Hold", task)
    monkeypatch.setitem(ENVIRONMENTS, task.id, ENVIRONMENTS["slipgym/Hold-v0"])
    monkeypatch.delitem(ENVIRONMENTS, "slipgym/Hold-v0")
    return task


@pytest.mark.parametrize("package", ["policies", "scripts"])
def test_no_id_is_glued_together(package):
    glued = re.compile(r"slipgym/\{|-v0[\"']|-v\{")
    allowed = re.compile(r"^\s*(\"\"\"|#)|slipgym:slipgym/\w+-v0|\"\w+/\w+-v0\"")
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for path in (ROOT / package).rglob("*.py")
        if path.name != "wheel_smoke.py"
        for line in path.read_text(encoding="utf-8").splitlines()
        if glued.search(line) and not allowed.search(line)
    ]
    assert found == []


def test_a_second_version_can_be_trained_and_evaluated(second_version):
    pytest.importorskip("stable_baselines3")
    from policies.training import files, vector

    assert find("hold") is second_version
    assert files.load("hold").task == "Hold"
    assert vector._id("Hold") == "slipgym:slipgym/Hold-v1"
    assert environment_of("hold", policies.make("hold"), None)[0] == "slipgym/Hold-v1"
    assert environment_of("constant_force", policies.make("constant_force"), "slipgym/Hold-v1")[0] == (
        "slipgym/Hold-v1"
    )
