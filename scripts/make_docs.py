"""Writes docs/environments/ from the environments' docstrings."""

import argparse
from pathlib import Path

from slipgym.envs.page import pages

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "environments"


def main() -> None:
    """Writes every page."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
        print(FOLDER / name)


if __name__ == "__main__":
    main()
