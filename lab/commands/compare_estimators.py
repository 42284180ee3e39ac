"""Compares the estimators on the same recorded episodes, in and out of the training of "gru"."""

from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym compare-estimators --rows 32 --estimators adaptive --estimators gru
  slipgym compare-estimators --weights runs/gru__20260101-120000-000/gru.npz
\n
See docs/learned_estimator.md.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    configuration: Annotated[
        Path | None,
        typer.Argument(help="YAML file of the training.", show_default="lab/learned_estimator/gru.yaml"),
    ] = None,
    rows: Annotated[int, typer.Option(min=1, help="Environments of each combination.")] = 32,
    estimators: Annotated[
        list[str] | None, typer.Option(help="Those compared; all if none.", show_default=False)
    ] = None,
    weights: Annotated[str, typer.Option(help='File of "gru"; that of the clone if none.')] = "",
    seed: Annotated[int, typer.Option(min=0, max=400, help="Of the episodes.")] = 0,
) -> None:
    """Print the errors of the estimators on the same recordings."""
    import estimator
    from lab.learned_estimator import config
    from lab.learned_estimator.compare import compare, wide
    from lab.learned_estimator.gru import NAME
    from policies.evaluation.frames import markdown

    own = {"gru": (NAME, {"weights": weights})}
    entrants = {name: own.get(name, (name, {})) for name in estimators or [*estimator.names(), *own]}
    with wrong_arguments():
        training = config.read(configuration or config.OWN)
        for kind, parameters in entrants.values():
            estimator.make(kind, **parameters)
    typer.echo(markdown(wide(compare(training, entrants, rows, seed=seed)), 1))
