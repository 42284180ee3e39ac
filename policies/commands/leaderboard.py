"""Ranks all estimators on the same records: who finds mu_c, r and mu_s, when, and how surely."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import usage_errors

EPILOG = """
Examples:\n
\b
  slipgym leaderboard --quick
  slipgym leaderboard --estimator my_package.friction:SPECIFICATION
\n
docs/leaderboard.md explains the tables; slipgym policy-leaderboard --estimator NAME plays episodes with one.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    estimator: Annotated[
        list[str] | None, typer.Option(help="An own estimator to enter, module:attribute; repeatable.")
    ] = None,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
    quick: Annotated[
        bool, typer.Option("--quick", help="A few coarse records, to see that it works.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the sensors' noise.")] = 0,
) -> None:
    """Run all estimators on all scenarios; writes a folder with tables and a picture."""
    from policies.leaderboard import run_leaderboard

    with usage_errors(ValueError, OSError):
        folder = run_leaderboard(output, quick, seed, own=estimator or ())
    typer.echo((folder / "leaderboard.md").read_text(encoding="utf-8").partition("\n## mu_c")[0])
    typer.echo(f"Look at:\n  {folder / 'leaderboard.png'}")
