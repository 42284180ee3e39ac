"""Compares the order of mean returns with that of success rates, for policies of every quality."""

from typing import Annotated

import typer

from estimator.registry import DEFAULT
from slipgym.registration import TASK_MODULES

TASKS = [module.rpartition(".")[2] for module in TASK_MODULES.values()]
EPILOG = """
Examples:\n
\b
  slipgym rank hinge
  slipgym rank --episodes 100 --randomization eval_ood
  slipgym rank hold --level hard
  slipgym rank --levels
\n
docs/rewards.md explains the tables.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    tasks: Annotated[
        list[str] | None,
        typer.Argument(
            help=f"Of {', '.join(TASKS)} (also LinearSlip or ids); all if none.", show_default=False
        ),
    ] = None,
    episodes: Annotated[int, typer.Option(min=2, help="Episodes of each policy.")] = 200,
    randomization: Annotated[str, typer.Option(help="A preset or a YAML file.")] = "train",
    level: Annotated[str, typer.Option(help="A level or a YAML file.")] = "easy",
    estimator: Annotated[str, typer.Option(help="Estimator of the environments.")] = DEFAULT,
    levels: Annotated[
        bool, typer.Option("--levels", help="Success by level instead, without randomization.")
    ] = False,
) -> None:
    """Print success and mean return of many policies, and how often both have the same order."""
    import pandas as pd

    from policies.research.leaderboard.tables import markdown
    from policies.research.reward_order.run import by_level, played, sentence
    from policies.research.reward_order.zoo import zoo
    from slipgym.config.level import level_names
    from slipgym.tasks import find

    try:
        if levels:
            keys = [find(task).key for task in tasks or TASKS]
            found = [by_level(key, level_names(key), zoo(key), episodes, estimator=estimator) for key in keys]
            typer.echo(markdown(pd.concat(found), 1))
            return
        for task in tasks or TASKS:
            made = {"randomization": randomization, "level": level, "estimator": estimator}
            table = played(task, zoo(task), episodes, made)
            typer.echo(f"\n{task}\n\n{markdown(table)}\n\n{sentence(table)}")
    except (ValueError, FileNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
