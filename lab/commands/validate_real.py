"""Prints what limit surfaces, estimators and their slip decision say of real data of others."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym validate-real
  slipgym validate-real --data data
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    data: Annotated[
        Path | None,
        typer.Option(help="Folder that slipgym data filled; the extracts if none.", show_default=False),
    ] = None,
    extract: Annotated[bool, typer.Option("--extract", help="Only write the extracts, from --data.")] = False,
    resamples: Annotated[int, typer.Option(min=1, help="For the bootstrap intervals.")] = 400,
    seed: Annotated[int, typer.Option(min=0, help="Of the resamples.")] = 0,
) -> None:
    """Print what surfaces, estimators and their slip decision say of real data (docs/real_data.md)."""
    from lab.real.run import page, write_extracts

    with wrong_arguments():
        if extract and data is None:
            raise ValueError("--extract needs --data, the folder that slipgym data filled")
        if extract and data is not None:
            write_extracts(data)
            return
        text = page(data, resamples, seed)
    typer.echo(text)
