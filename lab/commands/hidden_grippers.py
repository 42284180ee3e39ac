"""Identifies hidden grippers and prints how often the intervals hold."""

from typing import Annotated

import typer

from lab.commands.options import Seed, application

EPILOG = """
Examples:\n
\b
  slipgym hidden-grippers --grippers 2
"""
app = application()


@app.command(epilog=EPILOG)
def main(grippers: Annotated[int, typer.Option(min=1, help="Hidden grippers.")] = 20, seed: Seed = 0) -> None:
    """Identify hidden grippers, simulated by another patch and rate: about a minute each."""
    from lab.hidden_grippers import rows

    for row in rows(range(seed, seed + grippers)):
        typer.echo(row)
