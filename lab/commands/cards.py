"""Prints what each learned policy that comes with slipgym solves, and where."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym cards
  slipgym cards hinge_memory --episodes 100
  slipgym cards --into build/cards
\n
docs/learned.md shows the table.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    names: Annotated[list[str] | None, typer.Argument(help="Policies; all of them by default.")] = None,
    episodes: Annotated[int, typer.Option(min=1, help="Episodes in each world.")] = 400,
    into: Annotated[
        Path | None,
        typer.Option(help="Instead: a folder for the policies with a model card each.", show_default=False),
    ] = None,
) -> None:
    """Print the table of the learned policies.

    It is solved [%] at "easy" and at the level of the training: as trained, with the randomizations
    "train" and "eval_ood", with the sensors and pads of "lab", on the distributed contact, in PyBullet.
    """
    from lab.cards import cards
    from policies.evaluation.frames import markdown

    try:
        if into is not None:
            write_cards(names or [], into)
            return
        table = cards(names or [], episodes)
    except (FileNotFoundError, FileExistsError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(markdown(table, 1))


def write_cards(names: list[str], into: Path) -> None:
    """Copy the policies into a new folder, each with its card README.md, whole or not at all.

    Raises:
        FileNotFoundError: There is no policy of a name.
        FileExistsError: The folder exists.
    """
    import shutil

    from lab.model_cards import card
    from policies.learned import pretrained
    from slipgym.atomic_io import new_folder

    with new_folder(into) as folder:
        for name in names or pretrained.folders():
            shutil.copytree(pretrained.locate(name), folder / name)
            (folder / name / "README.md").write_text(card(name), encoding="utf-8")
    typer.echo(f"Look at:\n  {into}")
