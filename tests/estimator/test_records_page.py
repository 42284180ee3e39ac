"""docs/records.md says what the code says."""

import re
from pathlib import Path

import pytest

from estimator import records
from estimator.records.summary import FRICTION, RADIUS
from estimator.records.units import UNITS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "records.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("key", UNITS)
def test_every_key_and_its_units_are_documented(key):
    (units,) = [
        row[1]
        for row in re.findall(r"^\| (.+?) \| (.+?) \|$", PAGE, flags=re.MULTILINE)
        if f"`{key}`" in row[0] and row[1] == ", ".join(UNITS[key])
    ]
    assert units


def test_the_mappings_on_the_page_are_read(tmp_path):
    wanted = {
        "f_n": records.Column("Fz", "N", -1.0),
        "v_y": records.Column("/slip.twist.linear.y", "m/s", -1.0),
    }
    mappings = re.findall(r"```yaml\n(.*?)```", PAGE, flags=re.DOTALL)
    for mapping, (key, column) in zip(mappings, wanted.items(), strict=True):
        (tmp_path / "mapping.yaml").write_text(mapping)
        assert records.load_columns(tmp_path / "mapping.yaml")[key] == column


def test_the_figures_on_the_page_are_those_of_the_shipped_record():
    (printed,) = re.findall(r"```text\n(.*?)```", PAGE, flags=re.DOTALL)
    record = records.load(ROOT / "examples" / "linear_slip_wood.csv.gz")
    assert printed.split() == records.report(records.estimate(record)).split()
    page = " ".join(PAGE.split())
    rls, plain = (records.estimate(record, "rls", heuristic=on).estimates[-1]["mu_c"] for on in (True, False))
    assert f"With `--estimator rls` mu_c ends at {rls:.3f}," in page
    assert f"`--estimator rls --set heuristic=false` mu_c ends at {plain:.3f}:" in page


def test_the_plausible_ranges_are_documented():
    assert f"| mu_s, mu_c | outside {FRICTION[0]:g} to {FRICTION[1]:g} |" in PAGE
    assert f"outside {1e3 * RADIUS[0]:g} to {1e3 * RADIUS[1]:g} mm |" in PAGE
