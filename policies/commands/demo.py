"""Shows what friction is worth, with a figure."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands import evaluate
from policies.commands.several import Jobs

EPILOG = """
Examples:\n
\b
  slipgym demo
  slipgym demo --output /tmp/runs
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
    jobs: Jobs = -1,
) -> None:
    """Show what friction is worth: the gain over the strongest policy without it, and a figure."""
    evaluate.main(demo=True, output=output, jobs=jobs)
