"""The table of the learned policies that come with slipgym."""

import pytest

from lab import cards
from policies.policy_leaderboard import worlds
from policies.policy_leaderboard.worlds import WORLDS


def test_a_card_says_what_a_policy_is_given_and_solves(monkeypatch):
    monkeypatch.setattr(worlds, "WORLDS", WORLDS[:2])
    row = cards.cards(["carry_scratch"], 20, progress=False).iloc[0]
    assert (row["policy"], row["friction"]) == ("carry_scratch", "true")
    assert row["million steps"] > 1.0
    assert row["CPU [s]"] > 10.0
    assert list(row.index)[4:] == ["easy", "itself", "train", "dropped"]
    assert row["itself"] > 80.0 >= row["dropped"]


def test_an_unknown_policy_is_named():
    with pytest.raises(FileNotFoundError, match="carry_scrach"):
        cards.cards(["carry_scrach"], 2, progress=False)
