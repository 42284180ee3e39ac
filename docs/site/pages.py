"""Hook of mkdocs: adds pages from outside docs/, fills in the tables that are generated, adapts links."""

import re
import sys
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = [
    path.relative_to(ROOT).as_posix()
    for pattern in ("*.ipynb", "libraries/*.py")
    for path in sorted((ROOT / "examples").glob(pattern))
]
OUTSIDE = {
    "index.md": "README.md",
    "changes.md": "CHANGELOG.md",
    "contributing.md": "CONTRIBUTING.md",
    "citation.cff": "CITATION.cff",
    **{path: path for path in EXAMPLES},
}
"""Path in the site -> path in the repository."""


def on_files(files: Files, config: Any) -> Files:
    """Add the pages from outside docs/."""
    root = Path(config.config_file_path).parent
    for page, source in OUTSIDE.items():
        text = (root / source).read_text(encoding="utf-8").replace("](docs/", "](")
        files.append(File.generated(config, page, content=linked(text)))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Fill in a page's tables and files, and lead its links to the site's pages."""
    sys.path.insert(0, str(Path(__file__).parent))
    from tables import filled

    return linked(shown(filled(markdown)).replace("](../README.md", "](README.md"))


def shown(text: str) -> str:
    """The text with the files that `<!-- code: PATH -->` names."""
    return re.sub(
        r"<!-- code: (\S+) -->",
        lambda found: f"```python\n{(ROOT / found[1]).read_text(encoding='utf-8')}```",
        text,
    )


def linked(text: str) -> str:
    """The text with links to the pages of the site instead of files of the repository."""
    for page, source in OUTSIDE.items():
        text = text.replace(f"](../{source}", f"]({page}").replace(f"]({source}", f"]({page}")
        text = text.replace(f"](../../{source}", f"](../{page}")
    return text
