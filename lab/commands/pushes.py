"""Compares the estimators on 500 real pushes of a block on known supports."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym pushes MLab_EXP
  slipgym pushes MLab_EXP --held-out
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    source: Annotated[
        Path | None,
        typer.Argument(help="Clone of github.com/robinzhoucmu/MLab_EXP, or an extract.", show_default=False),
    ] = None,
    extract: Annotated[
        Path | None, typer.Option(help="Only write the extract of a clone to this file.", show_default=False)
    ] = None,
    held_out: Annotated[
        bool, typer.Option("--held-out", help="The smaller logs of a clone in place of the ten main ones.")
    ] = False,
    resamples: Annotated[int, typer.Option(min=1, help="For the bootstrap intervals.")] = 400,
    seed: Annotated[int, typer.Option(min=0, help="Of the resamples.")] = 0,
) -> None:
    """Print how far each estimator is from a fit that knows the support, log by log (docs/pushes.md)."""
    from lab import pushes
    from slipgym.atomic_io import check_file

    try:
        if extract is not None:
            check_file(extract)
        if held_out:
            logs, failed = pushes.read_held_out(source or pushes.EXTRACT)
            for name, why in failed.items():
                typer.echo(f"{name}: not readable: {why}")
        else:
            logs = pushes.read(source or pushes.EXTRACT)
        if extract is not None:
            pushes.write(logs, extract)
            return
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(pushes.run_pushes(logs, resamples, seed))
