"""Prints the acceptance figures of the physics; exit code 1 if one is not met."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

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


Only: TypeAlias = Annotated[list[str] | None, typer.Option(help="Experiments to run; all if none.")]


@app.command(epilog=EPILOG, cls=taking_several("--only"))
def main(only: Only = None) -> None:
    """Print the acceptance figures of the physics; exit code 1 if one is not met."""
    from slipgym.validation import EXPERIMENTS

    if accept(EXPERIMENTS, only):
        raise typer.Exit(1)


def line(figure: Figure) -> str:
    """One row of the table."""
    required, measured = (f"{value:.3g} {figure.unit}" for value in (figure.bound, figure.measured))
    return f"{figure.name:<54} {'<= ' + required:>13} {measured:>13}  {'yes' if figure.ok else 'NO'}"


def accept(experiments: Sequence[Callable[[], Iterable[Figure]]], only: Sequence[str] | None) -> int:
    """Print the figures of some experiments, all if `only` is empty; returns how many are not met.

    Raises:
        typer.BadParameter: A name in `only` is none of an experiment.
    """
    from tqdm import tqdm

    from estimator.suggestions import unknown

    known = {experiment.__name__: experiment for experiment in experiments}
    for name in only or ():
        if name not in known:
            raise typer.BadParameter(unknown("unknown name", name, list(known)), param_hint="--only")
    failed = 0
    tqdm.write(HEAD)
    for name in tqdm([name for name in known if not only or name in only], disable=None, leave=False):
        for figure in known[name]():
            tqdm.write(line(figure))
            failed += not figure.ok
    return failed
