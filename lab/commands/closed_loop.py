"""Plays the same episodes with each estimator in the loop: the controller acts on the estimate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, TypeAlias

import typer

EPILOG = """
Examples:\n
\b
  slipgym closed-loop --episodes 16 --estimators adaptive --task hold
  slipgym closed-loop --episodes 16 --estimators adaptive --estimators my_package.friction:SPECIFICATION
\n
docs/leaderboard.md explains the tables.
"""
Estimators: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(help="Names, or module:attribute of your own; all if none.", show_default=False),
]
LoopTasks: TypeAlias = Annotated[
    list[str] | None, typer.Option(help="Tasks; all if none.", show_default=False)
]
Parameters: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(help="Parameters of the estimators, as NAME=VALUE.", show_default=False),
]
Randomization: TypeAlias = Annotated[str, typer.Option(help="Preset of the episodes.")]
Contact: TypeAlias = Annotated[str, typer.Option(help="Friction model of the pads.")]
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    episodes: Annotated[int, typer.Option(min=1, help="Episodes of each combination.")] = 64,
    estimators: Estimators = None,
    task: LoopTasks = None,
    parameter: Parameters = None,
    randomization: Randomization = "none",
    contact: Contact = "ellipsoid",
    seed: Annotated[int, typer.Option(min=0, help="Of the first episode.")] = 0,
) -> None:
    """Print what the tasks' controllers solve with each estimator, and the errors of the estimates."""
    environments = {"randomization": randomization, "contact": contact}
    typer.echo(report(episodes, seed, estimators, task, parameter, ("realistic", "lab"), environments))


def report(
    episodes: int,
    seed: int,
    estimators: Sequence[str] | None,
    tasks: Sequence[str] | None,
    parameters: Sequence[str] | None,
    sensors: Sequence[str] | Mapping[str, Mapping[str, Any]],
    environments: Mapping[str, str],
) -> str:
    """The table of `lab.leaderboard.closed_loop.closed_loop`, and its means over several tasks.

    Args:
        episodes: Of each combination.
        seed: Of the first episode.
        estimators: Names; all if none.
        tasks: Names; all if none.
        parameters: Of the estimators, as NAME=VALUE.
        sensors: Presets, or label -> arguments of the environments.
        environments: Further arguments of the environments.

    Raises:
        typer.BadParameter: A name or a value is unknown.
    """
    import estimator
    from estimator.records import parse_settings
    from lab.leaderboard.closed_loop import closed_loop, pooled
    from policies.evaluation.frames import markdown

    try:
        changed = parse_settings(parameters or [])
        chosen = {name: {"name": name, **changed} for name in estimators or estimator.names()}
        rows = closed_loop(chosen, episodes, sensors, seed, ids(tasks), **environments)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    if len(set(rows["task"])) == 1:
        return markdown(rows, 1)
    return (
        f"{markdown(rows, 1)}\nOver the tasks, each with its own controller:\n\n{markdown(pooled(rows), 1)}"
    )


def ids(tasks: Sequence[str] | None) -> list[str]:
    """Ids of tasks, of all if none is named.

    Args:
        tasks: Names.

    Raises:
        typer.BadParameter: A name is unknown.
    """
    from slipgym.registration import TASK_MODULES
    from slipgym.tasks import find

    try:
        return [find(name).id for name in tasks] if tasks else list(TASK_MODULES)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
