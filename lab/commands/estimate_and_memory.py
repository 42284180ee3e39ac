"""Prints what an estimate adds to a policy with a memory."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application, wrong_arguments
from policies.commands.several import Jobs

EPILOG = """
Examples:\n
\b
  slipgym estimate-and-memory
  slipgym estimate-and-memory --seeds 2 --jobs 2
\n
docs/worth.md shows the table.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    seeds: Annotated[int, typer.Option(min=1, help="Seeds 0, 1, ... of each training.")] = 5,
    runs: Annotated[Path, typer.Option(help="Folder of finished runs; what it lacks is trained.")] = Path(
        "runs/estimate_and_memory"
    ),
    jobs: Jobs = -1,
    episodes: Annotated[int, typer.Option(min=1, help="Of each policy and world.")] = 400,
) -> None:
    """Train policies of Hold with and without estimates, print what they solve [%]: about an hour."""
    from lab.estimate_and_memory import table
    from policies.evaluation.frames import markdown

    with wrong_arguments():
        found = table(range(seeds), runs, jobs, episodes)
    typer.echo(markdown(found, 1))
