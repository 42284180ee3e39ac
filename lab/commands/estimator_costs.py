"""Prints what an update of each estimator costs, beside yardsticks of the same run."""

import typer

from lab.commands.options import application

EPILOG = """
Examples:\n
\b
  slipgym estimator-costs
"""
app = application()


@app.command(epilog=EPILOG)
def main() -> None:
    """Print the time of an update."""
    from lab.leaderboard.cost import costs
    from policies.evaluation.frames import markdown

    typer.echo(markdown(costs(), 1))
