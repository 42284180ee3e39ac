"""Adds trained policies to the pretrained ones that come with slipgym."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym ship runs/linear_slip__ppo__20260101-120000-000
\n
The best seed of each friction source goes to policies/learned/pretrained_policies/, the curves of all
to docs/learned/.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    studies: Annotated[list[Path], typer.Argument(help="Folders of finished studies.")],
) -> None:
    """Ship the best seeds of studies, trained as configs/training/ says, with the curves of all seeds."""
    from lab.shipping import ship

    try:
        shipped = ship(studies)
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo("\n".join(str(path) for path in shipped))
