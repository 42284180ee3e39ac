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
    closed_loop: Annotated[
        int, typer.Option(min=0, help="Instead: episodes of every task with the estimators in the loop.")
    ] = 0,
    estimators: Annotated[
        list[str] | None, typer.Option(help="Those in the loop; all if none.", show_default=False)
    ] = None,
    randomization: Annotated[str, typer.Option(help="Preset of the episodes in the loop.")] = "none",
    ablation: Annotated[
        bool, typer.Option("--ablation", help='Only print what each state and test of "adaptive" is worth.')
    ] = False,
    costs: Annotated[bool, typer.Option("--costs", help="Only print what an update costs.")] = False,
) -> None:
    """Runs all estimators on all scenarios; writes a folder with tables and a picture."""
    if ablation:
        from policies.research.leaderboard import ablation as removing
        from policies.research.leaderboard.scenarios import effort_of
        from policies.research.leaderboard.tables import markdown

        if closed_loop:
            found = removing.in_the_loop(closed_loop, seed, randomization=randomization)
        else:
            found = removing.worth(removing.ablation(effort_of(quick, seed)))
        typer.echo(markdown(found, 1 if closed_loop else 2))
        return
    if closed_loop:
        import estimator
        from policies.research.leaderboard import closed_loop as loop
        from policies.research.leaderboard.tables import markdown

        chosen = estimators or estimator.names()
        rows = loop.closed_loop(chosen, closed_loop, seed=seed, randomization=randomization)
        typer.echo(markdown(rows, 1))
        return
    if costs:
        from policies.research.leaderboard import cost
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(cost.costs(), 1))
        return
    from policies.research.leaderboard import run_leaderboard

    folder = run_leaderboard(output, quick, seed)
    typer.echo((folder / "leaderboard.md").read_text(encoding="utf-8").partition("\n## mu_c")[0])
    typer.echo(f"Look at:\n  {folder / 'leaderboard.png'}")
