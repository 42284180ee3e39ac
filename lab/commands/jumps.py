"""Prints how soon "adaptive" is right again when friction jumps."""

import typer

from lab.commands.closed_loop import Contact, LoopTasks, Parameters, ids
from lab.commands.options import Episodes, Seed, application, wrong_arguments

EPILOG = """
Examples:\n
\b
  slipgym jumps --episodes 16 --task linear_slip
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    episodes: Episodes = 64,
    task: LoopTasks = None,
    parameter: Parameters = None,
    contact: Contact = "ellipsoid",
    seed: Seed = 0,
) -> None:
    """Print the time of slip until mu_c is right, for LinearSlip and PlanarSlip if no task is named."""
    from estimator.records import parse_settings
    from lab.leaderboard.jumps import TASKS, jumps
    from policies.evaluation.frames import markdown

    with wrong_arguments():
        chosen = {"name": "adaptive", **parse_settings(parameter or [])}
        found = jumps(episodes, seed, ids(task) if task else TASKS, chosen, contact=contact)
    typer.echo(markdown(found, 2))
