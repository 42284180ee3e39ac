"""What only serves the paper and the studies stays apart from what a user imports."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2] / "policies"


def test_nothing_outside_of_research_imports_it():
    found = [
        str(path.relative_to(ROOT))
        for path in ROOT.rglob("*.py")
        if path.relative_to(ROOT).parts[0] not in ("research", "commands")  # commands start it
        and re.search(
            r"policies\.research|from policies import .*\bresearch\b", path.read_text(encoding="utf-8")
        )
    ]
    assert found == []
