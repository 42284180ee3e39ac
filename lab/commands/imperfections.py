"""Prints what each imperfection of the sensors "lab" costs in the loop."""

import typer

from lab.commands.options import Episodes, Seed, application
from policies.commands.closed_loop import Contact, Estimators, LoopTasks, Parameters, Randomization, report

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
    from policies.leaderboard.one_imperfection import one_imperfection

    environments = {"randomization": randomization, "contact": contact}
    typer.echo(report(episodes, seed, estimators, task, parameter, one_imperfection(), environments))
