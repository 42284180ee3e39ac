"""Prints what policies learn from nothing with several seeds."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application, wrong_arguments
from policies.commands.several import Jobs

EPILOG = """
Examples:\n
\b
  slipgym seeds
  slipgym seeds hinge_scratch carry_scratch --jobs 2
\n
docs/from_nothing.md shows the table.
"""
TASKS = (
    *("linear_slip", "fragile_hold", "rotational_slip", "hinge", "hold"),
    *("planar_slip", "carry", "pivot_to", "explore"),
)
app = application()


@app.command(epilog=EPILOG)
def main(
    names: Annotated[
        list[str] | None, typer.Argument(help="Configurations; by default all from nothing.")
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, help="Seeds 0, 1, ... of each.")] = 5,
    runs: Annotated[Path, typer.Option(help="Folder of finished runs; what it lacks is trained.")] = Path(
        "runs/seeds"
    ),
    jobs: Jobs = -1,
    episodes: Annotated[int, typer.Option(min=1, help="Of each policy.")] = 400,
) -> None:
    """Train with several seeds and print what the policies solve [%]: some hours."""
    from lab.seeds import table
    from policies.evaluation.frames import markdown

    chosen = names or [f"{task}_scratch" for task in TASKS]
    with wrong_arguments():
        found = table(chosen, range(seeds), runs, jobs, episodes)
    typer.echo(markdown(found, 1))
