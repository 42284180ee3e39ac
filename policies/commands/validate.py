"""Prints the acceptance figures of the physics; exit code 1 if one is not met."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
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
  slipgym validate --against mujoco bullet
  slipgym validate --against mujoco bullet --figure suite.png
\n
docs/physics.md and docs/slip_suite.md explain the figures.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--only", "--against"))
def main(
    only: Annotated[
        list[str] | None, typer.Option(help="Experiments to run; all if none.", show_default=False)
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            help="The slip suite instead: the same scenes in slipgym and in these engines: mujoco, bullet, "
            "drake, newton.",
            show_default=False,
        ),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option(help="With --against: draw its figure to this file.", show_default=False)
    ] = None,
) -> None:
    """Print the acceptance figures of the physics; exit code 1 if one is not met."""
    from estimator.suggestions import unknown
    from slipgym.atomic_io import check_file
    from slipgym.validation import EXPERIMENTS, suite

    names = [experiment.__name__ for experiment in EXPERIMENTS]
    for option, given, known in ("--only", only, names), ("--against", against, suite.ENGINES):
        for name in given or ():
            if name not in known:
                raise typer.BadParameter(unknown("unknown name", name, known), param_hint=option)
    if figure and not against:
        raise typer.BadParameter("needs --against", param_hint="--figure")
    if figure:
        try:
            check_file(figure)
        except OSError as error:
            raise typer.BadParameter(str(error), param_hint="--figure") from error
    if against:
        compare(against, figure)
    elif accept(only or names):
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


def compare(engines: Sequence[str], picture: Path | None) -> None:
    """Print the tables of the slip suite, or draw its figure; engines that are not installed are skipped."""
    from slipgym.atomic_io import new_file
    from slipgym.validation import suite

    chosen, results = [], []
    for engine in dict.fromkeys(("slipgym", *engines)):
        try:
            rows = suite.variants([engine])
            if picture is None:
                results += [suite.measure(row) for row in tqdm(rows, desc=engine, disable=None, leave=False)]
            else:
                suite.check(rows)
            chosen += rows
        except RuntimeError as error:
            tqdm.write(f"skipped: {error}", file=sys.stderr)
    if picture is None:
        print(suite.results_table(results), suite.friction_table(results), sep="\n\n")
    else:
        with new_file(picture) as partial:
            suite.draw(chosen, partial)
