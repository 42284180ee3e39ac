"""The benchmark of the first use counts what numba compiles, and charges time to the part it belongs to."""

import pytest

from lab.benchmarking import first_use
from lab.benchmarking.first_use import CASES, PARTS, Compilation
from slipgym._numba.compiled import compiled


@compiled
def part(x):
    return 2.0 * x


@compiled
def whole(x, k):
    return part(x) + part(k)


def test_functions_are_counted_once_for_every_signature(monkeypatch, tmp_path):
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path))
    with Compilation() as found:
        whole.compile("(float64, int64)")
    names = [name.rpartition(".")[2] for name in found.functions]
    assert names == ["part", "part", "whole"]
    assert all(found.spent[name] > 0.0 for name in PARTS)
    with Compilation() as again:
        whole.compile("(float64, int64)")
    assert again.functions == []


def test_a_pass_is_charged_without_those_within_it(monkeypatch):
    times = iter(range(100))
    monkeypatch.setattr(first_use, "process_time", lambda: float(next(times)))
    event = first_use.event
    with Compilation() as found:
        with (
            event.trigger_event(
                "numba:run_pass", {"name": "native_lowering [f]", "module": "m", "qualname": "f"}
            ),
            event.trigger_event("numba:llvm_lock"),
        ):
            pass
        with event.trigger_event("numba:run_pass", {"name": "ir_processing [f]"}):
            pass
    assert found.spent == {"type inference": 0.0, "lowering": 2.0, "other passes": 1.0, "LLVM": 1.0}
    assert found.functions == ["m.f"]


def test_the_table_counts_functions_and_what_is_left_of_the_time():
    step = {"seconds": 9.0, "recorded": 10.0, **dict.fromkeys(PARTS, 2.0), "functions": ["m.f", "m.f", "m.g"]}
    figures = {figure.name: figure for figure in first_use._figures("batch", [step, step, step])}
    assert figures["first step, batch: imports, hashing, storing, the step"].value == pytest.approx(2.0)
    assert figures["first step, batch: functions compiled"].value == 3
    assert figures["first step, batch: of them for another signature"].value == 1


@pytest.mark.slow  # it compiles the environment on an empty folder
def test_another_task_compiles_only_its_own_functions():
    found = first_use.measured("bullet", "slipgym/LinearSlip-v0")
    first, task, estimator = (step["functions"] for step in found)
    assert len(first) > 5 * len(task)
    assert all(
        name.startswith(
            (
                "slipgym.tasks.",
                "slipgym._numba.generate.",
                "numba.",
                "slipgym.world.",
                "slipgym.contact.soft_pad.",
            )
        )
        for name in task
    )
    assert all(name.startswith(("estimator.", "numba.")) for name in estimator)
    assert set(CASES) == {"PyBullet", "batch"}
