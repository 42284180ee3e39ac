import json

import numpy as np
import pandas as pd
import pytest
import yaml

from policies.evaluation import evaluate, load_experiment, report, trial
from policies.evaluation.plan import plan
from policies.evaluation.trial import record, run_trials

FILES = {
    "environment.yaml",
    "errors_constant_force.png",
    "experiment.yaml",
    "series.parquet",
    "summary.csv",
    "summary.md",
    "tracking_constant_force.png",
    "trials.csv",
    "trials.parquet",
    "versions.json",
}


@pytest.fixture
def run(small, tmp_path):
    return evaluate(small(), tmp_path / "runs", jobs=1, progress=False)


def test_a_run_folder_holds_everything_and_nothing_else_is_left(run, small, tmp_path):
    assert {path.name for path in run.iterdir()} == FILES
    assert list((tmp_path / "runs").iterdir()) == [run]
    assert run.name.startswith("small__0__")
    assert load_experiment(run / "experiment.yaml") == small()
    environment = yaml.safe_load((run / "environment.yaml").read_text())
    assert environment["object"]["mass"] == 0.2
    assert list(environment["tasks"]) == ["linear_slip"]
    assert environment["tasks"]["linear_slip"]["tolerance"] == 0.002
    assert {"python", "numpy", "gymnasium", "slipgym"} <= set(json.loads((run / "versions.json").read_text()))


def test_the_table_of_trials(run, small):
    trials = pd.read_parquet(run / "trials.parquet")
    assert len(trials) == len(plan(small())) == 16
    assert not trials.isna().any(axis=None)
    assert set(trials["friction"]) == {"estimated", "true"}
    assert trials["success"].dtype == trials["dropped"].dtype == bool
    assert set(trials["tolerance_mm"]) == {2.0}
    assert set(trials["steps"]) == {36}
    pd.testing.assert_frame_equal(
        trials, pd.read_csv(run / "trials.csv"), check_dtype=False, check_exact=False
    )
    series = pd.read_parquet(run / "series.parquet")
    firsts = trials.index[trials["trial"] == 0]
    assert list(series["row"].unique()) == list(firsts)
    assert len(series) == trials.loc[firsts, "steps"].sum()


def test_a_policy_that_ignores_friction_does_the_same_in_paired_trials(run):
    trials = pd.read_parquet(run / "trials.parquet")
    told, true = (trials[trials["friction"] == name].reset_index() for name in ("estimated", "true"))
    for column in ("seed", "final_error_mm", "mean_force_N", "final_mu_c"):
        pd.testing.assert_series_equal(told[column], true[column])
    summary = pd.read_csv(run / "summary.csv")
    difference = summary[summary["metric"] == "difference of final_error_abs_mm"]
    assert difference[["value", "low", "high"]].to_numpy().tolist() == [[0.0, 0.0, 0.0]]


def test_the_summary_agrees_with_the_table(run):
    trials, summary = pd.read_parquet(run / "trials.parquet"), pd.read_csv(run / "summary.csv")
    row = summary.query("friction == 'true' and material == 'case' and metric == 'rms_error_mm'")
    group = trials.query("friction == 'true' and material == 'case'")
    assert row["n"].item() == len(group) == 4
    assert row["value"].item() == pytest.approx(group["rms_error_mm"].mean())
    assert row["low"].item() <= row["value"].item() <= row["high"].item()
    assert "| constant_force | true |" in (run / "summary.md").read_text()
    words = report(run)
    assert "final error, signed [mm]" in words
    assert str(run / "tracking_constant_force.png") in words


def test_a_run_of_true_friction_alone_reports_it(small, tmp_path):
    """Its label column holds nothing but "true", which a reader could take for a boolean."""
    folder = evaluate(small(friction=[{"source": "true"}], trials=1), tmp_path, progress=False)
    assert "constant_force  true " in report(folder)


def test_a_run_without_an_estimator_has_dashes_for_estimates(small, tmp_path):
    friction = [{"source": "true", "estimator": None}]
    folder = evaluate(small(friction=friction, trials=1), tmp_path, progress=False)
    page = (folder / "summary.md").read_text(encoding="utf-8")
    assert "| –" in page
    assert "nan" not in page


@pytest.mark.slow
def test_results_do_not_depend_on_the_number_of_processes(small):
    experiment = small()
    one, two = (run_trials(experiment, plan(experiment), jobs, progress=False) for jobs in (1, 2))
    assert [result.row for result in one] == [result.row for result in two]
    for a, b in zip(one, two, strict=True):
        assert (a.series is None) == (b.series is None)
        for name in a.series or ():
            np.testing.assert_array_equal(a.series[name], b.series[name])


def test_hold_needs_the_force_of_statics(small):
    experiment = small(
        task="Hold",
        materials=["wood"],
        sensors="ideal",
        vary={},
        policies=[{"name": "constant_force", "parameters": {"force": 20.0}}],
        options={
            "duration": 0.3,
            "shake_amplitude": 0.0,
            "shake_pitch": 0.0,
            "poke_impulse": [0.0, 0.0],
            "object_mass": 0.3,
        },
    )
    recording = record(experiment, plan(experiment)[0])
    assert recording.success
    needed = 0.3 * 9.81 / (2.0 * 0.5155)  # half the weight per finger, over mu_s of wood
    np.testing.assert_allclose(recording.needed_force, needed, rtol=1e-3)


def test_hold_is_drawn_too(small, tmp_path):
    experiment = small(task="Hold", vary={}, options={"duration": 0.3}, materials=["random"])
    run = evaluate(experiment, tmp_path, progress=False)
    assert (run / "grip_constant_force.png").stat().st_size > 10_000


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_a_run_without_a_complete_cell_leaves_no_folder(small, tmp_path, monkeypatch, error):
    def fail(*_):
        raise error("planted")

    monkeypatch.setattr("policies.evaluation.run.run_trials", fail)
    with pytest.raises(error, match="planted"):
        evaluate(small(trials=1), tmp_path, progress=False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.quick_cases("OSError-planar", "KeyboardInterrupt-bullet")
@pytest.mark.parametrize("engine", ["planar", "bullet"])
@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_a_run_that_is_broken_off_keeps_its_complete_cells(small, tmp_path, monkeypatch, error, engine):
    if engine == "bullet":
        pytest.importorskip("pybullet")
    experiment = small(engine=engine, trials=2)
    count, real = len(plan(experiment)), trial.run_block
    whole = [result.row for result in run_trials(experiment, plan(experiment), progress=False)]

    def fail(experiment, trials):
        if trials[-1] == plan(experiment)[-1]:
            raise error("planted")
        return real(experiment, trials)

    monkeypatch.setattr(trial, "run_block", fail)
    with pytest.raises(error, match="planted") as broken:
        evaluate(experiment, tmp_path, progress=False)
    (run,) = tmp_path.iterdir()
    assert broken.value.__notes__ == [f"the trials that are finished are in {run}"]
    names = {"INCOMPLETE", "environment.yaml", "experiment.yaml", "series.parquet", "versions.json"}
    assert {path.name for path in run.iterdir()} == names | {"trials.csv", "trials.parquet"}
    trials = pd.read_parquet(run / "trials.parquet")
    lost = 2 if engine == "bullet" else count // 2  # a cell; on the planar engine those of one condition
    assert len(trials) == len(pd.read_csv(run / "trials.csv")) == count - lost
    pd.testing.assert_frame_equal(trials, pd.DataFrame(whole[: count - lost]), check_dtype=False)
    assert (run / "INCOMPLETE").read_text().startswith(f"{count - lost} of {count} trials")
    with pytest.raises(FileNotFoundError, match="not complete"):
        report(run)


def test_an_interrupt_while_figures_are_drawn_loses_no_trial(small, tmp_path, monkeypatch):
    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("policies.evaluation.run.draw", fail)
    with pytest.raises(KeyboardInterrupt):
        evaluate(small(), tmp_path, progress=False)
    (run,) = tmp_path.iterdir()
    assert len(pd.read_parquet(run / "trials.parquet")) == len(plan(small()))
    assert (run / "INCOMPLETE").exists()
    assert not (run / "summary.csv").exists()


def test_an_error_says_which_trial(small):
    experiment = small(policies=[{"name": "constant_force", "parameters": {"force": 99.0}}])
    with pytest.raises(ValueError, match="force = 99") as caught:
        run_trials(experiment, plan(experiment), 1, progress=False)
    assert "'material': 'wood'" in caught.value.__notes__[0]


def test_a_policy_in_need_of_friction_says_so(small):
    experiment = small(policies=[{"name": "linear_slip"}], friction=[{"source": "none"}])
    with pytest.raises(ValueError, match="friction_source='none'"):
        run_trials(experiment, plan(experiment)[:1], 1, progress=False)
