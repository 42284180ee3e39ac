"""Prints what an installation takes."""

import subprocess
from typing import Annotated

import typer

from lab.commands.options import application

EPILOG = """
Examples:\n
\b
  slipgym install-sizes
  slipgym install-sizes --python python3.12
\n
docs/install.md shows the table.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    python: Annotated[list[str] | None, typer.Option(help="Interpreters; repeatable.")] = None,
) -> None:
    """Install slipgym into new environments, print size and time: about a minute each."""
    from lab.install_sizes import table
    from policies.evaluation.frames import markdown

    try:
        found = table(python or ["python3.11", "python3.12", "python3.13"])
    except (OSError, subprocess.CalledProcessError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(markdown(found, 0))
