"""docs/estimator.md says what the code says, and its examples print what it prints."""

import dataclasses
import re
from pathlib import Path

import pytest

import estimator
from tests.estimator.exact_records import ellipsoid

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "estimator.md").read_text(encoding="utf-8")
FIELDS = [
    field
    for kind in (
        estimator.AdaptiveParameters,
        estimator.RlsParameters,
        estimator.JointParameters,
        estimator.DiscParameters,
        estimator.UkfParameters,
    )
    for field in dataclasses.fields(kind)
]


def test_every_parameter_is_documented():
    texts = [field.metadata["doc"] for field in FIELDS]
    assert [text for text in texts if len(text.split()) < 4 or not text.endswith(".")] == []


@pytest.mark.parametrize("name", estimator.Estimate._fields)
def test_every_result_is_documented(name):
    assert f"| `{name}` |" in PAGE


def test_the_spreads_on_the_page_of_adaptive_are_those_of_its_parameters():
    rows = re.findall(
        r"\| (\S+) `(\w+)` \|$", (ROOT / "docs" / "adaptive.md").read_text(), flags=re.MULTILINE
    )
    defaults = dataclasses.asdict(estimator.AdaptiveParameters())
    assert {name for _, name in rows} > {"sd_log_mu_c0", "sd_log_ratio", "sd_log_r0", "sd_zero", "sd_cop"}
    assert {name: float(value) for value, name in rows} == {name: defaults[name] for _, name in rows}


def code_blocks() -> list[str]:
    return re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)


def test_the_log_loop_runs(tmp_path, monkeypatch, capsys):
    rows = [
        ",".join(map(str, (t, *wrench, *twist))) for t, wrench, twist in ellipsoid(360, 0.02, 1.0, 0.4, 0.01)
    ]
    (tmp_path / "finger_1.csv").write_text("\n".join(["t,f_x,f_y,f_n,tau,v_x,v_y,omega", *rows]))
    monkeypatch.chdir(tmp_path)
    exec(compile(code_blocks()[0], "log loop", "exec"), {})
    printed = capsys.readouterr().out
    assert printed.startswith("mu_s 1.500  mu_c 0.400  r 0.0100 m\nconfidence: 0.00  1.00  1.00\n")
    assert "OnlineEstimator('rls')\n" in printed


def test_the_figures_on_locking_out_are_printed_by_their_code(capsys):
    exec(compile(code_blocks()[1], "locking out", "exec"), {})
    assert f"```text\n{capsys.readouterr().out}```" in PAGE


def test_the_files_that_the_pages_name_exist():
    docs = ROOT / "docs"
    named = {
        path
        for page in (
            "adaptive.md",
            "learned_estimator.md",
            "estimator.md",
            "adding_an_estimator.md",
            "records.md",
        )
        for path in re.findall(
            r"`((?:estimator|lab|scripts|tests|examples)/[\w./]+\.\w+)`", (docs / page).read_text()
        )
    }
    assert len(named) > 5
    assert {path for path in named if not (ROOT / path).exists()} == set()
