import os
import subprocess
import sys
from pathlib import Path

import policies
from estimator import DEFAULT
from policies.study import load_study
from policies.study.conditions import conditions

ROOT = Path(__file__).resolve().parents[2]


def call(folder, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}
    return subprocess.run(
        [sys.executable, ROOT / "scripts" / "study.py", *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_help_teaches(invoke):
    done = invoke("study", "--help")
    assert done.exit_code == 0, done.stderr
    assert "slipgym study full --jobs 2" in done.stdout


def test_an_unknown_study_is_refused_by_name(tmp_path, invoke):
    done = invoke("study", "quik")
    assert done.exit_code == 2
    assert "quick" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_missing_package_names_the_extra_before_anything_runs(tmp_path, invoke, monkeypatch):
    for name in [name for name in sys.modules if name.startswith(("policies.study", "policies.parallel"))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delattr(policies, "study", raising=False)
    monkeypatch.delattr(policies, "parallel", raising=False)
    monkeypatch.setitem(sys.modules, "joblib", None)
    done = invoke("study", "quick")
    assert done.exit_code == 2
    assert "slipgym[eval]" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_quick_study_takes_two_tasks_of_the_planar_engine():
    study = load_study("quick")
    assert (study.tasks, study.level, study.kinds) == (
        ("Hold", "Hinge"),
        "hard",
        ("classic", "memory", "recurrent"),
    )
    assert study.estimators == (DEFAULT,)
    assert {world.engine for world in study.worlds} == {"planar"}
    assert sum(condition.episodes for condition in conditions(study, {})) <= 400
