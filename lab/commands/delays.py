"""Prints "adaptive" in stick-slip with velocities whose age it is not given."""

import typer

from lab.commands.options import Quick, Seed, application

EPILOG = """
Examples:\n
\b
  slipgym delays --quick
"""
app = application()


@app.command(epilog=EPILOG)
def main(quick: Quick = False, seed: Seed = 0) -> None:
    """Print the mean error of mu_c for each age of the velocities."""
    from lab.leaderboard.delays import delays
    from policies.evaluation.frames import markdown
    from policies.leaderboard.scenarios import effort_of

    typer.echo(markdown(delays(effort_of(quick, seed)), 1))
