"""Prints the acceptance figures of the physics; exit code 1 if one is not met."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer
from tqdm import tqdm

from policies.commands.several import taking_several

if TYPE_CHECKING:
    from slipgym.validation import Figure

HEAD = f"{'figure':<54} {'required':>13} {'measured':>13}  ok"
EPILOG = """
Examples:\n
\b
  slipgym validate
  slipgym validate --only breakaway steady
\n
docs/physics.md explains the figures.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--only"))
def main(
    only: Annotated[
        list[str] | None, typer.Option(help="Experiments to run; all if none.", show_default=False)
    ] = None,
) -> None:
    """Print the acceptance figures of the physics; exit code 1 if one is not met."""
    from estimator.suggestions import unknown
    from slipgym.validation import EXPERIMENTS

    names = [experiment.__name__ for experiment in EXPERIMENTS]
    for name in only or ():
        if name not in names:
            raise typer.BadParameter(unknown("unknown name", name, names), param_hint="--only")
    if accept(only or names):
        raise typer.Exit(1)


def line(figure: Figure) -> str:
    """One row of the table."""
    required, measured = (f"{value:.3g} {figure.unit}" for value in (figure.bound, figure.measured))
    return f"{figure.name:<54} {'<= ' + required:>13} {measured:>13}  {'yes' if figure.ok else 'NO'}"


def accept(chosen: Sequence[str]) -> int:
    """Print the acceptance figures of some experiments; returns how many are not met."""
    from slipgym.validation import EXPERIMENTS

    failed = 0
    tqdm.write(HEAD)
    for experiment in tqdm([e for e in EXPERIMENTS if e.__name__ in chosen], disable=None, leave=False):
        for figure in experiment():
            tqdm.write(line(figure))
            failed += not figure.ok
    return failed
