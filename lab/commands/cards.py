"""Prints what each learned policy that comes with slipgym solves, and where."""

from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym cards
  slipgym cards hinge_memory --episodes 100
\n
docs/learned.md shows the table.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    names: Annotated[list[str] | None, typer.Argument(help="Policies; all of them by default.")] = None,
    episodes: Annotated[int, typer.Option(min=1, help="Episodes in each world.")] = 400,
) -> None:
    """Print the table of the learned policies.

    It is solved [%] at "easy" and at the level of the training: as trained, with the randomizations
    "train" and "eval_ood", with the sensors and pads of "lab", on the distributed contact, in PyBullet.
    """
    from lab.cards import cards
    from policies.leaderboard.tables import markdown

    try:
        table = cards(names or [], episodes)
    except FileNotFoundError as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(markdown(table, 1))
