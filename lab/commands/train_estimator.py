"""Trains the network of the estimator "gru"."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym train-estimator
  slipgym train-estimator --seed 1 --output runs
\n
The training needs torch (the extra train) and about ten minutes of one processor. An environment uses what
it wrote with estimator={"name": "lab.learned_estimator.gru:SPECIFICATION", "weights": "…/gru.npz"}.
See docs/learned_estimator.md.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    configuration: Annotated[
        Path | None,
        typer.Argument(help="YAML file of the training.", show_default="lab/learned_estimator/gru.yaml"),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, max=400, help="Of episodes, first weights and order.")] = 0,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
) -> None:
    """Record episodes, fit the network, write a folder with gru.npz."""
    with wrong_arguments():
        from lab.learned_estimator import config
        from lab.learned_estimator.run import WEIGHTS, train

        folder = train(config.read(configuration or config.OWN), output, seed)
    typer.echo(f"Look at:\n  {folder / WEIGHTS}\n  {folder / 'curve.csv'}")
