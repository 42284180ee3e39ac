import numpy as np
import pandas as pd
import pytest

from policies.study import run as runner
from policies.study import run_study, words
from policies.study.conditions import conditions
from policies.study.config import load_study
from policies.study.store import Store, fingerprint, sources

FILES = {
    "conditions",
    "constant_grip",
    "constant_grip.csv",
    "episodes.parquet",
    "benefits.csv",
    "outcomes.csv",
    "shares.csv",
    "study.yaml",
    "transfer.csv",
    "versions.json",
}


@pytest.fixture(autouse=True)
def few_forces(monkeypatch):
    """Three forces instead of many."""
    original = runner.constant_grips
    monkeypatch.setattr(runner, "constant_grips", lambda *a, **k: original(*a, candidates=3, **k))


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


@pytest.fixture
def run(small, output):
    """Run once; from then on the conditions are there."""
    return run_study(small(), output, 1, progress=False)


def test_the_folder_holds_everything(run, small):
    assert run.name == "study__small__0"
    assert {path.name for path in run.iterdir()} == FILES
    assert load_study(run / "study.yaml") == small()
    episodes = pd.read_parquet(run / "episodes.parquet")
    assert len(episodes) == 2 * (4 + 1 + 1)
    assert not episodes.isna().any(axis=None)
    assert set(episodes["source"]) == {"none", "nominal", "estimated", "true"}
    constant = pd.read_csv(run / "constant_grip.csv")
    assert list(constant["task"]) == ["LinearSlip"]
    assert constant["force_N"].between(0.6, 25.0).all()
    assert (constant["n"] == 2).all()
    by_seed = episodes.groupby("block")["seed"].nunique()
    assert list(by_seed) == [1, 1]


def test_policies_that_are_left_out_are_named(run, small, output, capsys):
    run_study(small(kinds=["classic", "imitation"], imitation="nowhere"), output, 1, progress=False)
    assert "left out: LinearSlip: no policy of kind imitation for none; looked for" in capsys.readouterr().err


@pytest.mark.slow
def test_what_is_there_is_not_run_again(run, small, output, monkeypatch):
    before = (run / "episodes.parquet").read_bytes()

    def fail(*_):
        raise AssertionError("planted")

    monkeypatch.setattr("policies.study.store.run_block", fail)
    assert run_study(small(), output, 1, progress=False) == run
    assert (run / "episodes.parquet").read_bytes() == before
    with pytest.raises(AssertionError, match="planted"):
        run_study(small(estimators=["joint"]), output, 1, progress=False)


@pytest.mark.slow
def test_a_study_that_was_broken_off_goes_on(run, small, output, tmp_path, monkeypatch):
    from policies.study import store

    study, count = small(), [0]
    actual = store.run_block

    def some(*arguments):
        count[0] += 1
        if count[0] == 4:
            raise KeyboardInterrupt
        return actual(*arguments)

    monkeypatch.setattr(store, "run_block", some)
    with pytest.raises(KeyboardInterrupt):
        run_study(study, tmp_path, 1, progress=False)
    kept = list((tmp_path / run.name / "conditions").iterdir())
    assert len(kept) == 3
    again = run_study(study, tmp_path, 1, progress=False)
    assert count[0] == 4 + 9
    pd.testing.assert_frame_equal(*(pd.read_parquet(each / "episodes.parquet") for each in (again, run)))


def test_a_cell_is_known_by_all_that_decides_its_result(small, monkeypatch):
    study = small()
    one, *others = conditions(study, {})
    marks = {fingerprint(condition, study) for condition in (one, *others)}
    assert len(marks) == 1 + len(others)
    assert fingerprint(one, small(seed=1)) not in marks
    assert fingerprint(one, small(name="other", episodes=1)) in marks
    monkeypatch.setattr("policies.study.store.sources", lambda: sources() + "changed")
    assert fingerprint(one, study) not in marks


@pytest.mark.parametrize("what", ["preset", "level", "estimator"])
def test_a_cell_is_known_by_the_content_of_files(small, tmp_path, monkeypatch, what):
    file = tmp_path / ("fading.py" if what == "estimator" else "mine.yaml")
    first, second = {
        "preset": ("mu_c: {uniform: [0.5, 0.6]}\n", "mu_c: {uniform: [0.2, 0.25]}\n"),
        "level": ("randomization: {mu_c: {uniform: [0.5, 0.6]}}\n", "settings: {tolerance: 0.004}\n"),
        "estimator": ("from estimator.rls import *\n", "from estimator.rls import *\nGAIN = 2\n"),
    }[what]
    if what == "estimator":
        own = "from dataclasses import replace\nOWN = replace(SPECIFICATION, name='fading:OWN')\n"
        first, second = first + own, second + own
    monkeypatch.syspath_prepend(tmp_path)
    file.write_text(first, encoding="utf-8")
    given = {"presets": [str(file)], "level": str(file), "estimators": ["fading:OWN"]}
    study = small(**{key: value for key, value in given.items() if key.startswith(what)})
    cells = conditions(study, {})
    before = [fingerprint(cell, study) for cell in cells]
    assert [fingerprint(cell, study) for cell in cells] == before
    file.write_text(second, encoding="utf-8")
    assert all(fingerprint(cell, study) != mark for cell, mark in zip(cells, before, strict=True))


def test_what_another_process_has_kept_is_taken(small, tmp_path):
    study = small()
    store, (condition, *_) = Store(tmp_path, study), conditions(study, {})
    for value in (1, 2):
        store.write(condition, pd.DataFrame({"seed": [value]}))
    assert list(store.read(condition)["seed"]) == [1]


def test_a_damaged_cell_is_named_with_the_way_on(small, tmp_path):
    study = small()
    store, (condition, *_) = Store(tmp_path, study), conditions(study, {})
    store.write(condition, pd.DataFrame({"seed": [1]}))
    store.table(condition).write_bytes(b"PAR1")
    with pytest.raises(ValueError, match=r"episodes\.parquet: .*delete its folder"):
        store.read(condition)


def test_a_broken_cell_is_no_cell(small, tmp_path):
    study = small()
    store, (condition, *_) = Store(tmp_path, study), conditions(study, {})
    with pytest.raises(AttributeError):
        store.write(condition, None)  # type: ignore[arg-type]
    assert not store.table(condition).exists()
    assert list(tmp_path.iterdir()) == []


def test_what_the_terminal_says(run, small):
    said = words(small(), run)
    assert "LinearSlip  train   classic   estimated disc" in said
    assert "not significant" in said
    assert str(run / "outcomes.csv") in said


def test_a_study_without_all_sources_has_no_shares(run, small, output):
    study = small(
        worlds=[
            {"label": "PyBullet, ellipsoid", "engine": "bullet", "contact": "ellipsoid", "sources": ["true"]}
        ]
    )
    folder = run_study(study, output, 1, progress=False)
    assert len(pd.read_csv(folder / "shares.csv")) == 0
    assert "LinearSlip  train   classic   true" in words(study, folder)


def test_nothing_to_run_is_an_error(small, tmp_path):
    study = small(kinds=["learned"], learned=str(tmp_path))
    with pytest.raises(ValueError, match="no condition to run; LinearSlip: no policy of kind learned"):
        run_study(study, tmp_path, progress=False)


def test_both_engines_run_the_same_episode(run):
    """An episode of 0.3 s that does not stick: 0.1 mm apart in 5 s of stick-slip (test_engines.py)."""
    episodes = pd.read_parquet(run / "episodes.parquet").query("source == 'estimated'")
    bullet, core = (group for _, group in episodes.groupby("world", sort=False))
    np.testing.assert_allclose(bullet["mean_force_N"], core["mean_force_N"], rtol=0.05)
    assert list(bullet["seed"]) == list(core["seed"])
