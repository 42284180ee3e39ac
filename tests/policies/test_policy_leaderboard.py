"""The leaderboard of policies: outcomes, entries, table and picture."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from policies.commands.policy_leaderboard import app
from policies.evaluation.play import ROWS, Played
from policies.evaluation.plots.style import styled
from policies.learned import pretrained
from policies.policy_leaderboard import entries, run
from policies.policy_leaderboard.entries import (
    Member,
    best_constant,
    bounds,
    constant,
    entered,
    further,
    learned,
    opponents,
)
from policies.policy_leaderboard.folder import plot_policies, write
from policies.policy_leaderboard.run import COLUMNS, by_level, episodes_of, outcomes, play_all, worth
from policies.policy_leaderboard.run import table as gains

SHORT = {"config": {"tasks": {"hold": {"duration": 0.5}}}}


def test_firm_grips_win_and_the_table_says_how():
    played = play_all("hold", "easy", [constant(0.6), constant(20.0)], 6, SHORT, progress=False)
    table = outcomes("hold", "easy", played)
    assert list(table.columns) == list(COLUMNS)
    firm, weak = table.iloc[0], table.iloc[1]
    assert (firm["policy"], weak["policy"]) == ("constant 20 N", "constant 0.6 N")
    assert firm["solved [%]"] == 100.0 > firm["low"] > 50.0
    assert weak["dropped [%]"] == 100.0
    assert firm["grip [N]"] == pytest.approx(20.0, abs=3.0)  # rises from the initial force
    assert weak["slid [mm]"] > 10.0 > 1.0 > firm["slid [mm]"]


@pytest.mark.parametrize(
    "world",
    [{}, pytest.param({"sensors": "lab", "randomization": "lab"}, marks=pytest.mark.slow)],
    ids=["itself", "lab"],
)
@pytest.mark.parametrize("task", ["hold", "fragile_hold"])
def test_the_oracle_bounds_what_a_policy_can_solve(task, world):
    (best,) = bounds(task)
    played = episodes_of(task, best, 60, {"level": "hard", **world})
    assert played.success.mean() >= 0.9
    assert episodes_of("hold", best, 10, {"level": "easy"}).success.all()


def episodes(*solved: int) -> Played:
    """Episodes of which some are solved, all else equal."""
    zero = np.zeros(len(solved))
    return Played(np.array(solved, dtype=bool), zero.astype(bool), zero, zero, zero)


def test_the_worth_of_friction_is_against_the_strongest_policy_without_it():
    sources = {"a (3 N)": "none", "controller, memory of slips": "none", "controller, nominal": "nominal"}
    sources |= {"controller, estimated": "estimated", "weak": "estimated", "controller, true": "true"}
    members = [Member(name, constant(1.0).policy, {"friction_source": s}) for name, s in sources.items()]
    played = {
        "a (3 N)": episodes(0, 0, 0, 0),
        "controller, memory of slips": episodes(1, 0, 1, 0),
        "controller, nominal": episodes(1, 0, 0, 0),
        "controller, estimated": episodes(1, 1, 1, 0),
        "weak": episodes(0, 0, 0, 1),
        "controller, true": episodes(1, 1, 1, 1),
    }
    row = worth("hold", "hard", members, played)
    assert row["strongest without friction"] == "memory of slips"
    assert (row["without"], row["estimated"], row["true"], row["gain"]) == (50.0, 75.0, 100.0, 25.0)
    assert (row["low"], row["high"]) == (0.0, 75.0)  # of four pairs one differs: 0 to 3 of them in a resample
    other = worth("carry", "hard", members, {**played, "controller, estimated": episodes(1, 1, 1, 1)})
    nothing = worth("hinge", "hard", members[:3], played)
    assert list(gains([row, nothing, other])["task"]) == ["Carry", "Hold", "Hinge"]
    assert np.isnan(gains([nothing])["gain"][0])


def test_blocks_of_rows_play_the_same_episodes(monkeypatch):
    whole = episodes_of("hold", constant(3.0), 5, SHORT)
    monkeypatch.setitem(ROWS, "planar", 2)
    parts = episodes_of("hold", constant(3.0), 5, SHORT)
    for one, other in zip(whole, parts, strict=True):
        np.testing.assert_array_equal(one, other)


def test_pybullet_plays_the_same_task():
    found = episodes_of("hold", constant(20.0), 2, SHORT, "bullet")
    assert found.success.all()
    assert found.grip == pytest.approx(episodes_of("hold", constant(20.0), 2, SHORT).grip, rel=0.02)


def test_the_constant_grip_is_chosen_on_other_episodes():
    best = best_constant("hold", SHORT, 4)
    assert best.name.startswith("best constant (")
    own, weak = episodes_of("hold", best, 8, SHORT), episodes_of("hold", constant(0.6), 8, SHORT)
    assert own.success.sum() > weak.success.sum()


def test_opponents_and_entries():
    names = [member.name.partition(" (")[0] for member in opponents("hold", SHORT, 2)]
    assert names[0] == "best constant"
    assert {f"controller, {source}" for source in ("none", "nominal", "estimated", "true")} < set(names)
    sources = ("none", "nominal", "estimated", "true")
    assert [member.name for member in further("PlanarSlip")] == [
        f"planar_slip_continuous, {s}" for s in sources
    ]
    assert further("hold") == []
    (mine,) = entered(["policies.controllers.hold:HoldPolicy"], "true")
    assert mine.name == "policies.controllers.hold:HoldPolicy, true"
    assert mine.arguments["friction_source"] == "true"
    assert mine.arguments["observation_mode"] == "deviations"
    with pytest.raises(FileNotFoundError, match="no policy at 'nowhere'"):
        entered(["nowhere"], "true")


def test_policies_that_come_with_slipgym_are_named_by_what_they_learned_with(monkeypatch, tmp_path):
    assert "learned from nothing, true" in [member.name for member in learned("hinge")]
    for name, source in (("hold_scratch", "true"), ("hold_memory", "estimated"), ("hold_lab", None)):
        shutil.copytree(pretrained.folders()["carry_scratch"], tmp_path / name)
        file = tmp_path / name / "policy.json"
        values = json.loads(file.read_text())
        del values["environment"]["arguments"]["friction_source"]
        values["environment"]["arguments"] |= {"friction_source": source} if source else {}
        file.write_text(json.dumps(values))
    monkeypatch.setattr(pretrained, "FOLDER", tmp_path)
    assert {member.name: member.arguments["friction_source"] for member in learned("hold")} == {
        "learned from nothing, true": "true",
        "recurrent, estimated": "estimated",
        "recurrent, trained on lab, estimated": "estimated",
    }
    assert learned("carry") == []


def test_a_folder_has_table_and_picture(tmp_path):
    rows = [
        ("Hold", level, name, solved, 0.0, 100.0, 1.0, 0.0, 5.0, 0.1)
        for level in ("easy", "hard")
        for name, solved in (("best constant (5 N)", 20.0), ("controller, true", 100.0))
    ]
    table = pd.DataFrame(rows, columns=pd.Index(COLUMNS))
    folder = write(table, tmp_path, {"episodes": 200, "engine": "planar"})
    written = {"leaderboard.json", "policies.csv", "policies.png", "versions.json"}
    assert {path.name for path in folder.iterdir()} == written
    board = json.loads((folder / "leaderboard.json").read_text())
    assert board["played"] == {"episodes": 200, "engine": "planar"}
    assert board["versions"]["slipgym"] is not None
    assert [row["solved [%]"] for row in board["rows"]] == [20.0, 100.0, 20.0, 100.0]
    assert list(board["rows"][0]) == list(COLUMNS)
    wide = by_level(table)
    assert list(wide.columns) == ["task", "level", "best constant", "controller, true"]
    assert list(wide["level"]) == ["easy", "hard"]
    assert list(wide["controller, true"]) == [100.0, 100.0]
    other = pd.DataFrame([("Carry", *rows[0][1:])], columns=pd.Index(COLUMNS))
    several = by_level(pd.concat([table, other], ignore_index=True))
    assert list(several.columns) == ["task", "level", "best constant"]  # the other one plays Hold alone
    assert list(several["task"]) == ["Hold", "Hold", "Carry"]
    with styled():
        figure = plot_policies(table)
        (axes,) = figure.axes
    pixels = 670 / figure.get_figwidth() / 72  # of a point, on a page
    assert min(text.get_fontsize() * pixels for text in [*axes.texts, *axes.get_yticklabels()]) > 10.0
    assert [label.get_text() for label in axes.get_yticklabels()] == ["controller, true", "best constant"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["hld"], "hold"),
        (["hold", "--engine", "mujoco"], "mujoco"),
        (["hold", "--policy", "nowhere"], "nowhere"),
        (["hold", "--level", "hardest"], "hardest"),
        (["linear_slip", "--policy", "policies.controllers.hold:HoldPolicy"], "is for Hold"),
        (["linear_slip", "--policy", str(pretrained.folders()["hold_scratch"])], "trained in"),
    ],
)
def test_wrong_arguments_are_named(arguments, said, tmp_path):
    result = CliRunner().invoke(app, [*arguments, "--output", str(tmp_path)])
    assert result.exit_code == 2
    assert said in result.output
    assert not list(tmp_path.iterdir())


def test_a_policy_plays_in_other_worlds(monkeypatch):
    chosen = [world for world in run.WORLDS if world.name in ("itself", "train", "bullet")]
    monkeypatch.setattr(run, "WORLDS", tuple(world._replace(share=1.0) for world in chosen))
    firm, weak = constant(25.0), constant(0.6)
    table = run.generalisation("fragile_hold", "easy", [firm, weak], 3, {"estimator": "rls"}, progress=False)
    assert list(table.columns) == ["task", "level", "policy", "itself", "train", "bullet"]
    assert list(table["policy"]) == [firm.name, weak.name]
    for world in chosen:
        given = {**world.arguments, "level": "easy"}
        played = episodes_of("fragile_hold", firm, 3, given, world.engine)
        assert table.loc[0, world.name] == pytest.approx(100.0 * played.success.mean())


def test_a_memory_of_slips_is_configured_for_the_rate_at_which_it_acts(monkeypatch):
    seen = []
    monkeypatch.setattr(entries, "strongest", lambda task, members, *_: seen.extend(members) or members[0])
    entries.remembering("planar_slip", {}, 2)
    for each in seen:
        rate = each.policy._controller.config.physics.control_rate
        assert rate * each.arguments.get("frame_skip", 1) == 120


def test_a_policy_keeps_the_friction_source_that_it_asks_for(tmp_path, monkeypatch):
    text = "class Blind:\n    modes = {'action_mode': 'grip_force', 'friction_source': 'none'}\n"
    (tmp_path / "blind_entry.py").write_text(text + "    def predict(self, *_, **__):\n        pass\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    (entry,) = entered(["blind_entry:Blind"], "estimated")
    assert entry.arguments["friction_source"] == "none"
    assert entry.name == "blind_entry:Blind, none"


def test_a_policys_file_says_its_friction_source():
    place = str(pretrained.folders()["hold_scratch"])
    assert [each.arguments["friction_source"] for each in entered([place, place], None)] == ["true", "true"]
    (on_estimates,) = entered([place], "estimated")
    assert on_estimates.arguments["friction_source"] == "estimated"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--friction-source", "true"], "--friction-source true: of policies entered with --policy"),
        (["--without", "scale"], "--without scale: of the sensors 'lab', and these are 'realistic'"),
    ],
)
def test_an_option_without_effect_is_refused(arguments, said, tmp_path):
    done = CliRunner().invoke(app, ["hold", *arguments, "--output", str(tmp_path)], env={"COLUMNS": "200"})
    assert done.exit_code == 2
    assert said in done.stderr


def test_what_is_asked_for_twice_plays_once(tmp_path, monkeypatch):
    monkeypatch.setattr(entries, "opponents", lambda *_: [constant(20.0)])
    arguments = ["hold", "Hold", "--level", "easy", "--level", "easy", "--episodes", "2"]
    done = CliRunner().invoke(app, [*arguments, "--output", str(tmp_path)])
    assert done.exit_code == 0, done.output
    (table,) = tmp_path.glob("*/policies.csv")
    assert len(pd.read_csv(table)) == 1


def test_an_action_that_is_not_finite_names_its_policy():
    class Lost:
        def predict(self, observation, state=None, episode_start=None, deterministic=True):
            return np.full((len(observation), 1), np.nan), state

    with pytest.raises(ValueError, match=r"^lost: actions\[0, 0\] .* = nan"):
        episodes_of("hold", Member("lost", Lost(), {}), 2, SHORT)
