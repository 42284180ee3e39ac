"""The table of the learned policies that come with slipgym."""

import pytest
from typer.testing import CliRunner

import policies
from lab import cards
from lab.commands.cards import app
from lab.model_cards import solved
from policies.evaluation.play import play_episodes
from policies.policy_leaderboard import run
from policies.policy_leaderboard.run import WORLDS


def test_a_card_says_what_a_policy_is_given_and_solves(monkeypatch):
    monkeypatch.setattr(run, "WORLDS", WORLDS[:2])
    row = cards.cards(["carry_scratch"], 20, progress=False).iloc[0]
    assert (row["policy"], row["friction"]) == ("carry_scratch", "true")
    assert row["million steps"] > 1.0
    assert row["CPU [s]"] > 10.0
    assert list(row.index)[4:] == ["easy", "itself", "train", "dropped"]
    assert row["itself"] > 80.0 >= row["dropped"]


def test_a_policy_has_the_sensors_of_its_training(monkeypatch):
    monkeypatch.setattr(run, "WORLDS", WORLDS[:1])
    policy = policies.load("hinge_lab")
    where = {**policy.modes, "friction_source": "none", "sensors": "lab", "level": "hard"}
    played = play_episodes("Hinge", policy, where, range(20))
    assert cards.cards(["hinge_lab"], 20, progress=False)["itself"].item() == 100.0 * played.success.mean()


def test_an_unknown_policy_is_named():
    with pytest.raises(FileNotFoundError, match="carry_scrach"):
        cards.cards(["carry_scrach"], 2, progress=False)


def test_cards_are_written_beside_the_policies_or_not_at_all(tmp_path):
    done = CliRunner().invoke(app, ["hold_memory", "--into", str(tmp_path / "cards")])
    assert done.exit_code == 0, done.output
    folder = tmp_path / "cards" / "hold_memory"
    assert {path.name for path in folder.iterdir()} == {"README.md", "policy.json", "weights.safetensors"}
    text = (folder / "README.md").read_text()
    assert text.startswith("---\nlicense: mit\n")
    for said in ("slipgym/Hold-v0", 'level "hard"', 'friction "none"', "million steps"):
        assert said in " ".join(text.split())
    done = CliRunner().invoke(app, ["hold_memry", "--into", str(tmp_path / "wrong")])
    assert done.exit_code == 2
    assert not (tmp_path / "wrong").exists()


def test_a_card_shows_the_printed_figures_with_their_commit():
    head = "printed: 2026-11-27, commit abcdef0\n\n"
    head += "| policy | friction | million steps | CPU [s] | easy | itself |\n"
    text = head + "| --- | --- | ---: | ---: | ---: | ---: |\n| mine | true | 1.0 | 2.0 | 99.0 | 90.5 |\n"
    assert "commit abcdef0" in solved("mine", text)
    assert "| itself | 90.5 |" in solved("mine", text)
    assert "Not printed yet" in solved("other", text)
