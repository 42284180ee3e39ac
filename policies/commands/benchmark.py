"""Measures what the environments cost, each figure beside its reference of the same run."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym benchmark
  slipgym benchmark --env hold --pairs 100 --json figures.json
  slipgym benchmark --workloads
  slipgym benchmark --split
  slipgym benchmark --split --estimator disc
  slipgym benchmark --bullet
  slipgym benchmark --first-use
\n
docs/performance.md explains the figures.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    env: Annotated[str, typer.Option(help="Task, also LinearSlip or an id.")] = "linear_slip",
    pairs: Annotated[int, typer.Option(min=1, help="Pairs of timed blocks.")] = 300,
    json: Annotated[
        Path | None, typer.Option(help="File to write the figures to, too.", show_default=False)
    ] = None,
    learning: Annotated[
        bool, typer.Option("--learning", help="Learning instead; needs the extra train.")
    ] = False,
    workloads: Annotated[
        bool,
        typer.Option(
            "--workloads",
            help="Every task instead: held firmly, about the slip limit, its controller, a learned policy.",
        ),
    ] = False,
    split: Annotated[
        bool,
        typer.Option("--split", help="The headline and the parts of a step of the vector environment alone."),
    ] = False,
    bullet: Annotated[
        bool, typer.Option("--bullet", help="The environment with PyBullet and its bare loop alone.")
    ] = False,
    estimator: Annotated[
        list[str] | None,
        typer.Option(
            help="With --split: also the headline with this estimator; repeatable.", show_default=False
        ),
    ] = None,
    first_use: Annotated[
        bool, typer.Option("--first-use", help="The first steps after an installation: compiling.")
    ] = False,
    optimisations: Annotated[
        bool, typer.Option("--optimisations", help="The benefit of each optimisation instead.")
    ] = False,
) -> None:
    """Print the speed of an environment and of its parts."""
    if estimator and not split:
        raise typer.BadParameter("--estimator needs --split")
    from slipgym.tasks import find

    try:
        env_id = find(env).id
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    if optimisations:
        from slipgym.benchmarking.optimisations import optimisations as measured
        from slipgym.benchmarking.report import line, machine, publish

        typer.echo(line(machine()))
        publish(measured(env_id, max(3, pairs // 20)), json)
    elif split:
        from slipgym.benchmarking.batch import headline_and_parts
        from slipgym.benchmarking.report import line, machine, publish

        typer.echo(line(machine()))
        try:
            publish(headline_and_parts(env_id, max(3, pairs // 5), estimator or ()), json)
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error
    elif first_use:
        from slipgym.benchmarking.first_use import first_use as compiling
        from slipgym.benchmarking.report import line, machine, publish

        typer.echo(line(machine()))
        publish(compiling(env_id), json)
    elif bullet:
        from slipgym.benchmarking.run import with_bullet

        with_bullet(env_id, pairs, json)
    elif workloads:
        from policies.evaluation.workloads import benchmark as all_tasks

        all_tasks(env_id, pairs, json)
    elif learning:
        from policies.training.benchmark import benchmark as learner

        learner(env_id, pairs, json)
    else:
        from slipgym.benchmarking.run import benchmark

        benchmark(env_id, pairs, json)
