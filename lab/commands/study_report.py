"""Writes the report of a finished study: one page with figures, tables and videos."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application

EPILOG = """
Examples:\n
\b
  slipgym study-report runs/study__quick__0
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    folder: Annotated[Path, typer.Argument(help="What slipgym study wrote.")],
) -> None:
    """Write report.html into the folder of a study; needs the extra study."""
    try:
        from lab.study_report.page import write_report
    except ModuleNotFoundError as error:
        raise typer.BadParameter(f"{error.name} is not installed: pip install 'slipgym[study]'") from error
    try:
        page = write_report(folder, f"slipgym study-report {folder}")
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(f"Look at:\n  {page}")
