"""The examples of docs/contact.md run one after the other, and print what the page says."""

import re
from pathlib import Path

from lab.validation import EXPERIMENTS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "contact.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


def test_examples_print_what_they_say(capsys):
    assert len(EXAMPLES) >= 2
    names: dict[str, object] = {}
    for example in EXAMPLES:
        exec(example, names)
        said = re.findall(r"# prints (.*)", example)
        assert capsys.readouterr().out.splitlines() == said
        assert said


def test_the_commands_name_experiments_that_exist():
    named = set(re.findall(r"\bpatch_\w+", PAGE))
    assert named
    assert named <= {experiment.__name__ for experiment in EXPERIMENTS}
