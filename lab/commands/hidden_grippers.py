"""Identifies hidden grippers and prints how often the intervals hold."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import Seed, application

EPILOG = """
Examples:\n
\b
  slipgym hidden-grippers --grippers 2
  slipgym hidden-grippers --grippers 2 --tune
  slipgym hidden-grippers --seed 1 --log hidden.csv
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    grippers: Annotated[int, typer.Option(min=1, help="Hidden grippers.")] = 20,
    seed: Seed = 0,
    log: Annotated[
        Path | None, typer.Option(help="csv to write the log of one to, and end.", show_default=False)
    ] = None,
    tune: Annotated[
        bool, typer.Option("--tune", help="What a controller loses that is tuned on the identified one.")
    ] = False,
) -> None:
    """Identify hidden grippers, simulated by another patch and rate: about a minute each."""
    from lab import hidden_grippers, tuned_controller
    from lab.simulated_gripper import draw_gripper, simulated_log, write_log
    from slipgym.atomic_io import new_file

    if log is not None:
        try:
            with new_file(log) as path:
                write_log(simulated_log(draw_gripper(seed), seed), path)
        except OSError as error:
            raise typer.BadParameter(str(error)) from error
        typer.echo(f"Wrote {log}")
        return

    for row in (tuned_controller if tune else hidden_grippers).rows(range(seed, seed + grippers)):
        typer.echo(row)
