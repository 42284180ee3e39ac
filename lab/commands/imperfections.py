"""Prints what each imperfection of the sensors "lab" costs in the loop."""

from collections.abc import Mapping
from typing import Any

import typer

from lab.commands.closed_loop import Contact, Estimators, LoopTasks, Parameters, Randomization, report
from lab.commands.options import Episodes, Seed, application

EPILOG = """
Examples:\n
\b
  slipgym imperfections --episodes 16 --estimators adaptive --task hold
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    episodes: Episodes = 64,
    estimators: Estimators = None,
    task: LoopTasks = None,
    parameter: Parameters = None,
    randomization: Randomization = "none",
    contact: Contact = "ellipsoid",
    seed: Seed = 0,
) -> None:
    """Print the estimators in the loop with each imperfection of "lab" alone."""
    environments = {"randomization": randomization, "contact": contact}
    typer.echo(report(episodes, seed, estimators, task, parameter, one_imperfection(), environments))


def one_imperfection() -> Mapping[str, Mapping[str, Any]]:
    """Label -> arguments of the environments: none, one imperfection of "lab" each, all."""
    from policies.leaderboard.imperfections import IMPERFECTIONS, values_of

    cases: dict[str, Mapping[str, Any]] = {"realistic": {"sensors": "realistic"}}
    for label in IMPERFECTIONS:
        cases[label] = {"sensors": "realistic", "config": {"sensors": values_of(label)}}
    return cases | {"lab": {"sensors": "lab"}}
