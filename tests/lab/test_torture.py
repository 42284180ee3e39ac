"""A short part of the campaign (`make torture`), and the campaign itself: it goes on, it sees crashes."""

import pytest

pytest.importorskip("stable_baselines3")
from lab.torture import run
from lab.torture.cases import ACCEPTED, Attack

QUICK = {
    "keywords": 15,
    "configuration": 25,
    "randomization": 15,
    "reset options": 40,
    "actions": 60,
    "YAML files": 40,
    "policy folders": 40,
    "records": 20,
    "checkpoints": 30,
    "interrupts": 15,
    "lost clients": 4,
}
"""Attack -> cases of the short part; the others take many steps or processes."""
SEED = 2024


CASES = [pytest.param(name, marks=[pytest.mark.slow] * (name == "randomization")) for name in QUICK]
"""Randomization compiles every kind of pad and sensor."""


@pytest.mark.parametrize("name", CASES)
def test_every_outcome_is_explained(name):
    attack = run.ATTACKS[name]
    found = {k: run.outcome(attack, SEED, k) for k in range(QUICK[name])}
    assert {k: each for k, each in found.items() if each not in attack.allowed} == {}


@pytest.mark.slow
def test_a_campaign_goes_on_where_it_was_stopped(tmp_path):
    names = ["YAML files", "actions"]
    table = run.run(tmp_path / "whole", 1, 0.004, names, lambda _: None)
    broken = tmp_path / "broken"
    run.run(broken, 1, 0.002, names, lambda _: None)
    assert run.run(broken, 1, 0.004, names, lambda _: None) == table
    assert [line.split("|")[2].strip() for line in table.splitlines()[2:4]] == ["24", "16"]
    with pytest.raises(ValueError, match="holds a campaign with seed 1"):
        run.run(broken, 2, 0.004, names)


def test_a_crash_is_an_outcome(tmp_path, monkeypatch):
    """The worker does not know this attack and dies, as in a crash."""
    attack = Attack("unknown to the worker", lambda _: ACCEPTED, 1, (ACCEPTED,))
    monkeypatch.setitem(run.ATTACKS, attack.name, attack)
    table = run.run(tmp_path, 0, 1.0, [attack.name], lambda _: None)
    assert "| unknown to the worker | 1 |  | 1 |" in table
    assert "case 0: crash: exit status 1" in table


def test_an_exception_that_nobody_expects_is_named():
    def case(_):
        raise KeyError("surprise")

    assert run.outcome(Attack("a", case, 1, ()), 0, 0) == "unexplained: KeyError: 'surprise'"
