"""Prints what each state and each test of "adaptive" is worth in the loop."""

import typer

from lab.commands.options import Episodes, Seed, application, wrong_arguments
from policies.commands.closed_loop import Contact, LoopTasks, Randomization, ids

EPILOG = """
Examples:\n
\b
  slipgym loop-ablation --episodes 16 --task hold
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    episodes: Episodes = 64,
    task: LoopTasks = None,
    randomization: Randomization = "none",
    contact: Contact = "ellipsoid",
    seed: Seed = 0,
) -> None:
    """Print what is solved, and the errors, without each state and test of "adaptive"."""
    from lab.leaderboard.ablation import in_the_loop
    from policies.leaderboard.tables import markdown

    with wrong_arguments():
        found = in_the_loop(episodes, seed, tasks=ids(task), randomization=randomization, contact=contact)
    typer.echo(markdown(found, 1))
