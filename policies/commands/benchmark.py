"""Measures what the environments cost on this machine."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import usage_errors

EPILOG = """
Examples:\n
\b
  slipgym benchmark
  slipgym benchmark --env hold --pairs 100 --json figures.json
\n
docs/performance.md explains the figures.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    env: Annotated[str, typer.Option(help="Task, also LinearSlip or an id.")] = "linear_slip",
    pairs: Annotated[int, typer.Option(min=1, help="Ten times the timed blocks of each figure.")] = 300,
    json: Annotated[Path | None, typer.Option(help="File to write the figures to, too.")] = None,
) -> None:
    """Print steps per second of single environments and of batches, and their memory."""
    from slipgym.atomic_io import check_file
    from slipgym.benchmarking.run import benchmark
    from slipgym.tasks import find

    with usage_errors(ValueError, OSError):
        env_id = find(env).id
        if json is not None:
            check_file(json)
    benchmark(env_id, pairs, json)
