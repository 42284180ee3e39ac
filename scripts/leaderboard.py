"""Ranks all estimators on the same records: who finds mu_c, r and mu_s, when, and how surely."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command()
def main(
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
    quick: Annotated[bool, typer.Option(help="A few coarse records, to see that it works.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the sensors' noise.")] = 0,
    costs: Annotated[bool, typer.Option("--costs", help="Only print what an update costs.")] = False,
) -> None:
    """Runs all estimators on all scenarios; writes a folder with tables and a picture."""
    if costs:
        from policies.research.leaderboard import cost
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(cost.costs(), 1))
        return
    from policies.research.leaderboard import run_leaderboard

    folder = run_leaderboard(output, quick, seed)
    typer.echo((folder / "leaderboard.md").read_text(encoding="utf-8").partition("\n## mu_c")[0])
    typer.echo(f"Look at:\n  {folder / 'leaderboard.png'}")


if __name__ == "__main__":
    app()
