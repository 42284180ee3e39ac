"""Proposes the mapping of a log's columns, for `slipgym estimate`."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym map log.csv
  slipgym map bag.mcap --output columns.yaml --plot columns.png
\n
Columns are found by their names; units that the file does not say are guessed by the size of the values.
Check every line of the mapping before you use it. docs/records.md describes it.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    log: Annotated[
        Path, typer.Argument(help="csv, parquet, npz, HDF5, mat, xlsx, mcap or a bag.", show_default=False)
    ],
    output: Annotated[
        Path | None, typer.Option(help="YAML to write; printed otherwise.", show_default=False)
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Picture of the columns to write, as png.", show_default=False)
    ] = None,
) -> None:
    """Propose which column is what, its unit and its sign, and try the mapping on the log."""
    try:
        from estimator.records import guessing, proposal
        from slipgym.atomic_io import check_file, new_file, write

        for target in (output, plot):
            if target is not None:
                check_file(target)
        proposed = guessing.propose(log)
        if plot is not None:
            with new_file(plot) as partial:
                proposal.picture(proposed, log.name).savefig(partial, dpi=120)
        if output is not None:
            write(output, proposed.text().encode())
        refused, told = proposal.tried(log, proposed)
    except ModuleNotFoundError as error:
        raise typer.BadParameter(str(error)) from error
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo("\n".join(proposal.table(proposed)))
    typer.echo(f"\n{proposed.text() if output is None else f'Mapping: {output}'}")
    if refused:
        typer.echo(f"\nWith it, slipgym estimate says:\n{refused}")
        raise typer.Exit(1)
    typer.echo(
        "\n".join(["\nslipgym estimate reads the log with it. Check every unit that is guessed.", *told])
    )
