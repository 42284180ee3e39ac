"""Adds trained policies to the pretrained ones that come with slipgym."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym ship runs/carry__privileged_ppo__20260101-120000-000
  slipgym ship runs/carry__privileged_ppo__20260101-120000-000 --name carry_lab
\n
The best seed of each configuration goes to policies/learned/pretrained_policies/, by the configuration's
name, the curves of all to docs/learned/.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    studies: Annotated[list[Path], typer.Argument(help="Folders of finished studies.")],
    name: Annotated[
        str | None,
        typer.Option(
            help="Configuration that they were trained as.  [default: <task>_scratch]", show_default=False
        ),
    ] = None,
) -> None:
    """Ship the best seeds of studies, trained as configs/training/ says, with the curves of all seeds."""
    from lab.shipping import ship

    try:
        shipped = ship(studies, name)
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo("\n".join(str(path) for path in shipped))
