"""Finished studies become policies on the shelf and pages of curves."""

import csv
from dataclasses import fields

import pytest

pytest.importorskip("stable_baselines3")
import policies
from lab import shipping
from policies.learned import LearnedPolicy
from policies.training import files, folder, run_set
from policies.training.curve import Row, best

NAME = "linear_slip_lab"


@pytest.fixture
def configured(small, monkeypatch):
    """The small configuration as every one that comes with slipgym."""
    config = small(engine_threads=1)
    monkeypatch.setattr(shipping.files, "load", lambda _, others: files.changed(config, others))
    return config


def curve_of(rows, seed):
    names = [field.name for field in fields(Row)]
    return [Row(**{name: float(row[name]) for name in names}) for row in rows if row["seed"] == seed]


@pytest.mark.slow
def test_the_best_seed_goes_to_the_shelf_and_all_curves_to_the_pages(configured, tmp_path):
    begun = run_set.begin(configured, [0, 1], [], tmp_path / "runs")
    with pytest.raises(ValueError, match="is not finished"):
        shipping.ship([begun], NAME, tmp_path / "shelf", tmp_path / "pages")
    run_set.train_all(begun, progress=False)
    for _ in range(2):  # the second time in place of the first
        found = shipping.ship([begun], NAME, tmp_path / "shelf", tmp_path / "pages")
    assert [path.name for path in found] == [NAME]
    with (tmp_path / "pages" / f"{NAME}.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {(row["source"], row["seed"]) for row in rows} == {("estimated", seed) for seed in "01"}
    assert (tmp_path / "pages" / f"{NAME}.png").is_file()
    (path,) = found
    policy = policies.load(path)
    assert {file.name for file in path.iterdir()} == {"policy.json", "weights.safetensors"}
    assert isinstance(policy, LearnedPolicy)
    origin = policy.description.origin
    ends = [best(curve_of(rows, seed), configured.evaluation.episodes) for seed in "01"]
    chosen = best(ends, configured.evaluation.episodes)
    assert ends[origin.seeds[0]] == chosen
    assert origin.steps == chosen.steps
    assert origin.command.endswith(f"{NAME} --friction-source estimated --seeds {origin.seeds[0]}")


@pytest.mark.parametrize(
    ("changes", "name", "said"),
    [
        ({"ppo.gamma": 0.5}, None, r"configs/training/linear_slip_scratch\.yaml says: ppo differ"),
        ({"environment.friction_source": "true"}, NAME, r"linear_slip_lab\.yaml says: environment differ"),
    ],
)
def test_another_configuration_is_refused(configured, tmp_path, changes, name, said):
    begun = run_set.begin(files.changed(configured, changes), [0], [], tmp_path / "runs")
    folder.write_result(folder.runs(begun)[0], {"ended": "budget"})
    with pytest.raises(ValueError, match=said):
        shipping.ship([begun], name, tmp_path / "shelf", tmp_path / "pages")
    assert not (tmp_path / "shelf").exists()


def test_a_run_may_begin_as_any_policy_and_its_command_names_no_folder_of_a_machine(configured, tmp_path):
    start = "/home/me/runs/start/linear_slip_none_0/policy"
    begun = run_set.begin(files.changed(configured, {"privileged_ppo.start": start}), [0], [], tmp_path)
    (path,) = folder.runs(begun)
    folder.write_result(path, {"ended": "budget"})
    folder.write_curve(path, [])
    command = shipping._finished(path, NAME).command
    assert command.endswith("--seeds 0 --set privileged_ppo.start=linear_slip_none_0/policy")


def test_a_name_without_a_configuration_is_refused(small, tmp_path):
    begun = run_set.begin(small(), [0], [], tmp_path)
    folder.write_result(folder.runs(begun)[0], {"ended": "budget"})
    with pytest.raises(ValueError, match=r"unknown training configuration .*carry_scratch"):
        shipping.ship([begun], "carry_best", tmp_path / "shelf", tmp_path / "pages")
