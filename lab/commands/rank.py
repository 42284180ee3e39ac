"""Compares the order of mean returns with that of success rates, for policies of every quality."""

from typing import Annotated

import typer

from estimator.registry import DEFAULT
from lab.commands.options import application, wrong_arguments
from policies.commands.several import TASKS, Tasks

EPILOG = """
Examples:\n
\b
  slipgym rank hinge
  slipgym rank --episodes 100 --randomization eval_ood
  slipgym rank hold --level hard
\n
docs/rewards.md explains the tables.
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    tasks: Tasks = None,
    episodes: Annotated[int, typer.Option(min=2, help="Episodes of each policy.")] = 200,
    randomization: Annotated[str, typer.Option(help="A preset or a YAML file.")] = "train",
    level: Annotated[
        list[str] | None,
        typer.Option(help="Only this level, or a YAML file; repeatable.", show_default=False),
    ] = None,
    estimator: Annotated[str, typer.Option(help="Estimator of the environments.")] = DEFAULT,
) -> None:
    """Print success and mean return of many policies, and how often both have the same order."""
    from lab.reward_order.run import compared, played, sentence
    from lab.reward_order.zoo import zoo
    from policies.evaluation.frames import markdown
    from slipgym.config.level import level_names
    from slipgym.tasks import find

    with wrong_arguments():
        found = {}
        for task in tasks or TASKS:
            for name in level or level_names(find(task).key):
                made = {"randomization": randomization, "level": name, "estimator": estimator}
                table = found[find(task).name, name] = played(task, zoo(task), episodes, made)
                typer.echo(f"\n{task}, {name}\n\n{markdown(table)}\n\n{sentence(table)}")
        typer.echo(f"\n{markdown(compared(found), 1)}")
