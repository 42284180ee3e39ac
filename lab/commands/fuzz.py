"""Prints the errors of the estimators in simulated worlds that slipgym has no part in."""

from typing import Annotated

import typer

from estimator.registry import DEFAULT
from lab.commands.options import application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym fuzz 10000 10100
  slipgym fuzz 10000 10040 --estimators adaptive --estimators ukf
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    first: Annotated[int, typer.Argument(help="First seed, from 10000 on.")],
    last: Annotated[int, typer.Argument(help="Seed after the last one.")],
    estimators: Annotated[
        list[str] | None,
        typer.Option(help="Names, or module:attribute of your own; repeatable.", show_default=DEFAULT),
    ] = None,
) -> None:
    """Print the errors of estimators on records of an independent simulator, by kind of the pads [%]."""
    from lab.worlds import errors, table
    from policies.evaluation.frames import markdown

    with wrong_arguments():
        found = errors(first, last, estimators or [DEFAULT])
    typer.echo(markdown(table(found), 1))
