"""Hook of mkdocs: shows the file of a result below a link in a paragraph of its own, folded if it is long."""

import re
from pathlib import Path
from typing import Any

LINK = re.compile(r"^\[[^]]+\]\((?:\.\./)*results/(\w+\.txt)\)$", re.MULTILINE)
LONGEST = 36
"""Lines of a result that is shown open."""


def on_page_markdown(markdown: str, config: Any, **_: Any) -> str:
    """Add the content of each linked file of docs/results to a page."""
    folder = Path(config.docs_dir) / "results"
    return LINK.sub(lambda match: f"{match[0]}\n\n{shown((folder / match[1]).read_text('utf-8'))}", markdown)


def shown(text: str) -> str:
    """The content of a result as Markdown: commit and date, tables, other text in a fenced block."""
    _, head, content = text.split("\n\n", 2)
    printed = next(line for line in head.splitlines() if line.startswith("printed: "))
    content = re.sub(r"^#+ (.+)$", r"**\1**", content.strip("\n"), flags=re.MULTILINE)
    if not content:
        return f"*{printed.capitalize()}*"
    long = content.count("\n") >= LONGEST
    if not re.search(r"^\| ", content, re.MULTILINE):
        content = f"```text\n{content}\n```"
    if long:
        content = (
            f"<details markdown>\n<summary>All tables of this result</summary>\n\n{content}\n\n</details>"
        )
    return f"*{printed.capitalize()}*\n\n{content}"
