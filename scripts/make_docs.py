"""Writes docs/environments/ from the environments' docstrings, and pictures to docs/images/."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

DOCS = Path(__file__).resolve().parents[1] / "docs"
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command()
def main(pictures: Annotated[bool, typer.Option(help="Whether to make the pictures too.")] = True) -> None:
    """Write the pages and a picture of every registered environment, and an animation of all."""
    from lab.montage import write_montage, write_screenshots

    sys.path.insert(0, str(DOCS / "site"))
    for name, text in import_module("environments").pages().items():
        (DOCS / "environments" / name).write_text(text, encoding="utf-8")
        typer.echo(DOCS / "environments" / name)
    if pictures:
        for path in write_screenshots(DOCS / "images"):
            typer.echo(path)
        write_montage(DOCS / "images" / "tasks.gif")
        typer.echo(DOCS / "images" / "tasks.gif")


if __name__ == "__main__":
    app()
