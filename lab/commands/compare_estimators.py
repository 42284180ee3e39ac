"""Compares the estimators on the same recorded episodes, in and out of the training of "gru"."""

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
        str, typer.Argument(help="Name of a file in configs/estimators, or path of a YAML file.")
    ] = "gru",
    rows: Annotated[int, typer.Option(min=1, help="Environments of each combination.")] = 32,
    estimators: Annotated[
        list[str] | None, typer.Option(help="Those compared; all if none.", show_default=False)
    ] = None,
    weights: Annotated[str, typer.Option(help='File of "gru"; that of the package if none.')] = "",
    seed: Annotated[int, typer.Option(min=0, max=400, help="Of the episodes.")] = 0,
) -> None:
    """Print the errors of the estimators on the same recordings."""
    import estimator
    from lab.learned_estimator import config
    from lab.learned_estimator.compare import compare, wide
    from policies.leaderboard.tables import markdown

    entrants = {
        name: (name, {"weights": weights} if name == "gru" else {})
        for name in estimators or estimator.names()
    }
    with wrong_arguments():
        training = config.read(configuration)
        for kind, parameters in entrants.values():
            estimator.make(kind, **parameters)
    typer.echo(markdown(wide(compare(training, entrants, rows, seed=seed)), 1))
