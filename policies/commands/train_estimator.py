"""Trains the network of the estimator "gru", or compares it with the other estimators."""

from pathlib import Path
from typing import Annotated, Any

import typer

EPILOG = """
Examples:\n
\b
  slipgym train-estimator
  slipgym train-estimator --seed 1 --output runs
  slipgym train-estimator --compare 32 --estimators adaptive --estimators gru
  slipgym train-estimator --compare 32 --weights runs/gru__20260101-120000-000/gru.npz
\n
The training takes about ten minutes of one processor. An environment uses what it wrote with
estimator={"name": "gru", "weights": "…/gru.npz"}. See docs/learned_estimator.md.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    configuration: Annotated[
        str, typer.Argument(help="Name of a file in configs/estimators, or path of a YAML file.")
    ] = "gru",
    seed: Annotated[int, typer.Option(min=0, max=400, help="Of episodes, first weights and order.")] = 0,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
    compare: Annotated[
        int, typer.Option(min=0, help="Instead: estimators on episodes of as many environments.")
    ] = 0,
    estimators: Annotated[
        list[str] | None, typer.Option(help="Those compared; all if none.", show_default=False)
    ] = None,
    weights: Annotated[str, typer.Option(help="File that is compared; that of the package if none.")] = "",
) -> None:
    """Record episodes, fit the network, write a folder with gru.npz; or compare."""
    from policies.research.learned_estimator import config

    try:
        training = config.read(configuration)
    except (ValueError, FileNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
    if compare:
        typer.echo(_compared(training, compare, estimators or [], weights, seed))
        return
    from policies.research.learned_estimator.run import WEIGHTS, train

    folder = train(training, output, seed)
    typer.echo(f"Look at:\n  {folder / WEIGHTS}\n  {folder / 'curve.csv'}")


def _compared(training: Any, rows: int, names: list[str], weights: str, seed: int) -> str:
    import estimator
    from policies.research.leaderboard.tables import markdown
    from policies.research.learned_estimator.compare import compare, wide

    entrants = {
        name: (name, {"weights": weights} if name == "gru" else {}) for name in names or estimator.names()
    }
    try:
        for kind, parameters in entrants.values():
            estimator.make(kind, **parameters)
    except (ValueError, FileNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
    return markdown(wide(compare(training, entrants, rows, seed=seed)), 1)
