"""Measures what docs/performance.md states besides `slipgym benchmark`, each in a command of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from lab.commands.options import application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym benchmark-parts all
  slipgym benchmark-parts split --estimator disc
  slipgym benchmark-parts bullet --env hold --pairs 100 --json figures.json
\n
docs/performance.md explains the figures.
"""
app = application()
app.info.epilog, app.info.no_args_is_help = EPILOG, True
Env: TypeAlias = Annotated[str, typer.Option(help="Task, also LinearSlip or an id.")]
Pairs: TypeAlias = Annotated[int, typer.Option(min=1, help="Pairs of timed blocks.")]
Json: TypeAlias = Annotated[
    Path | None, typer.Option(help="File to write the figures to, too.", show_default=False)
]


@app.callback()
def parts() -> None:
    """Measure what the parts of a step, a first use and learning cost."""


@app.command("all")
def everything(env: Env = "linear_slip", pairs: Pairs = 300, json: Json = None) -> None:
    """The environment against a bare loop, contact models, sub-steps, batches, threads, resets."""
    from lab.benchmarking.run import benchmark

    benchmark(_id(env), pairs, json)


@app.command()
def bullet(env: Env = "linear_slip", pairs: Pairs = 300, json: Json = None) -> None:
    """The environment with PyBullet and its bare loop alone."""
    from lab.benchmarking.run import with_bullet

    with_bullet(_id(env), pairs, json)


@app.command()
def split(
    env: Env = "linear_slip",
    pairs: Pairs = 300,
    json: Json = None,
    estimator: Annotated[
        list[str] | None, typer.Option(help="Also with this estimator; repeatable.", show_default=False)
    ] = None,
) -> None:
    """The headline, and the parts of a step of the vector environment."""
    from lab.benchmarking.batch import headline_and_parts
    from slipgym.benchmarking.report import line, machine, publish

    typer.echo(line(machine()))
    with wrong_arguments():
        publish(headline_and_parts(_id(env), max(3, pairs // 5), estimator or ()), json)


@app.command()
def first_use(env: Env = "linear_slip", json: Json = None) -> None:
    """The first steps after an installation: compiling."""
    from lab.benchmarking.first_use import first_use as compiling
    from slipgym.benchmarking.report import line, machine, publish

    typer.echo(line(machine()))
    publish(compiling(_id(env)), json)


@app.command()
def workloads(env: Env = "linear_slip", pairs: Pairs = 300, json: Json = None) -> None:
    """Every task: held firmly, about the slip limit, its controller, a learned policy."""
    from lab.benchmarking.workloads import benchmark

    benchmark(_id(env), pairs, json)


@app.command()
def learning(env: Env = "linear_slip", pairs: Pairs = 300, json: Json = None) -> None:
    """Learning end to end; needs the extra train."""
    from lab.benchmarking.learning import benchmark

    benchmark(_id(env), pairs, json)


def _id(env: str) -> str:
    from slipgym.tasks import find

    with wrong_arguments():
        return find(env).id
