"""Tables of the benchmark, and that it measures what it says."""

import json

from slipgym.benchmarking import report, run
from slipgym.benchmarking.report import Figure, table, write

FIGURES = [Figure("fast", 1.2, "-", "<= 1.4"), Figure("slow", 30.0, "x", ">= 40"), Figure("free", 3.0, "us")]


def test_a_table_says_what_is_met():
    lines = table(FIGURES).splitlines()
    assert lines[2].endswith("<= 1.4: yes")
    assert lines[3].endswith(">= 40: NO")
    assert lines[4].endswith("us")


def test_figures_are_written_at_once(tmp_path):
    path = tmp_path / "figures.json"
    path.write_text("old")
    write(path, FIGURES)
    assert [figure["met"] for figure in json.loads(path.read_text())["figures"]] == [True, False, None]
    assert list(tmp_path.iterdir()) == [path]


def test_a_benchmark_names_every_engine_and_batch(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(run, "SIZES", (1, 8))
    path = tmp_path / "figures.json"
    run.benchmark("slipgym/Hold-v0", 1, path)
    figures = json.loads(path.read_text())["figures"]
    names = [figure["name"] for figure in figures]
    printed = capsys.readouterr().out
    assert len(names) == len(set(names))
    assert all(name in printed for name in names)
    assert all(figure["value"] > 0.0 for figure in figures)
    wanted = {f"one environment, {engine}: steps per second" for engine in run.engines()}
    wanted |= {f"batch of {n}, held firmly: steps per second" for n in (1, 8)}
    assert wanted <= set(names)


def test_a_library_that_is_missing_is_said(monkeypatch):
    monkeypatch.setattr(report, "LIBRARIES", ("numpy", "no-such-library"))
    assert "no-such-library not installed" in report.line(report.machine())
