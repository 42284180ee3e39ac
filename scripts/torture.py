"""Attacks slipgym with wrong values, crafted files, interrupts and many steps (docs/security.md)."""

from pathlib import Path
from typing import Annotated

import typer

from policies.console import spell_out

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command()
def main(
    folder: Annotated[Path, typer.Argument(help="Folder of the campaign; it goes on if it exists.")] = Path(
        "torture"
    ),
    seed: Annotated[int, typer.Option(min=0, help="Of the campaign.")] = 0,
    share: Annotated[float, typer.Option(min=0.0, help="Fraction of the cases of a full campaign.")] = 1.0,
    attack: Annotated[
        list[str] | None, typer.Option(help="One of the attacks by its name; several times: several.")
    ] = None,
) -> None:
    """Print a table of outcomes; the exit status is 1 if one of them is unexplained."""
    from policies.research.torture.run import run

    try:
        table = run(folder, seed, share, attack or [], lambda line: typer.echo(line, err=True))
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(table)
    if ", case " in table:
        raise typer.Exit(1)


if __name__ == "__main__":
    spell_out()
    app()
