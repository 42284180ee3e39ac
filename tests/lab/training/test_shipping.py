"""Finished studies become policies on the shelf and pages of curves."""

import csv
from dataclasses import fields

import pytest

pytest.importorskip("stable_baselines3")
import policies
from lab import shipping
from policies.learned import LearnedPolicy
from policies.training import files, run_set
from policies.training.curve import Row, best


@pytest.fixture
def configured(small, monkeypatch):
    """The small configuration as the one that its task has."""
    config = small(engine_threads=1)
    monkeypatch.setattr(shipping.files, "load", lambda _, others: files.changed(config, others))
    return config


def curve_of(rows, seed):
    names = [field.name for field in fields(Row)]
    return [Row(**{name: float(row[name]) for name in names}) for row in rows if row["seed"] == seed]


@pytest.mark.slow
def test_the_best_seed_goes_to_the_shelf_and_all_curves_to_the_pages(configured, tmp_path):
    begun = run_set.begin(configured, [0, 1], ["estimated", "none"], tmp_path / "runs")
    with pytest.raises(ValueError, match="is not finished"):
        shipping.ship([begun], tmp_path / "shelf", tmp_path / "pages")
    run_set.train_all(begun, progress=False)
    for _ in range(2):  # the second time in place of the first
        found = shipping.ship([begun], tmp_path / "shelf", tmp_path / "pages")
    assert [path.name for path in found] == ["linear_slip_estimated", "linear_slip_none"]
    with (tmp_path / "pages" / "linear_slip.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {(row["source"], row["seed"]) for row in rows} == {
        (s, k) for s in ("estimated", "none") for k in "01"
    }
    assert (tmp_path / "pages" / "linear_slip.png").is_file()
    for path in found:
        policy, source = policies.load(path), path.name.rsplit("_", 1)[1]
        assert {file.name for file in path.iterdir()} == {"policy.json", "weights.safetensors"}
        assert isinstance(policy, LearnedPolicy)
        origin, of_source = policy.description.origin, [row for row in rows if row["source"] == source]
        curves = [curve_of(of_source, seed) for seed in "01"]
        ends = [best(rows, configured.evaluation.episodes) for rows in curves]
        chosen = best(ends, configured.evaluation.episodes)
        assert ends[origin.seeds[0]] == chosen
        assert origin.steps == chosen.steps
        assert origin.command.endswith(f"linear_slip --friction-source {source} --seeds {origin.seeds[0]}")


def test_another_configuration_is_refused(configured, tmp_path):
    other = files.changed(configured, {"ppo.gamma": 0.5})
    begun = run_set.begin(other, [0], [], tmp_path / "runs")
    run_set.train_all(begun, progress=False)
    with pytest.raises(ValueError, match=r"not trained as configs/training/linear_slip\.yaml says"):
        shipping.ship([begun], tmp_path / "shelf", tmp_path / "pages")
