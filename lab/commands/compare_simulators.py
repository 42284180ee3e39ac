"""Compares the contact with other simulators: the same scenes in each (docs/slip_suite.md)."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application

EPILOG = """
Examples:\n
\b
  slipgym compare-simulators mujoco bullet
  slipgym compare-simulators mujoco bullet --figure suite.png
\n
docs/slip_suite.md explains the tables.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    engines: Annotated[
        list[str], typer.Argument(help="Of mujoco, bullet, drake, newton.", show_default=False)
    ],
    figure: Annotated[
        Path | None, typer.Option(help="Draw the suite's figure to this file instead.", show_default=False)
    ] = None,
) -> None:
    """Print the tables of the slip suite; simulators that are not installed are skipped."""
    from tqdm import tqdm

    from estimator.suggestions import unknown
    from lab import suite

    for name in engines:
        if name not in suite.ENGINES:
            raise typer.BadParameter(unknown("unknown name", name, suite.ENGINES), param_hint="ENGINES")
    chosen, results = [], []
    for engine in dict.fromkeys(("slipgym", *engines)):
        try:
            rows = suite.variants([engine])
            if figure is None:
                results += [suite.measure(row) for row in tqdm(rows, desc=engine, disable=None, leave=False)]
            else:
                suite.check(rows)
            chosen += rows
        except RuntimeError as error:
            tqdm.write(f"skipped: {error}", file=sys.stderr)
    if figure is None:
        typer.echo(f"{suite.results_table(results)}\n\n{suite.friction_table(results)}")
    else:
        suite.draw(chosen, figure)
