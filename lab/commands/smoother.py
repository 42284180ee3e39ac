"""Prints what the slips of an episode of PlanarSlip tell a fit that knows all but the unknowns."""

import typer

from lab.commands.options import Episodes, Seed, application

EPILOG = """
Examples:\n
\b
  slipgym smoother --episodes 16
"""
app = application()


@app.command(epilog=EPILOG)
def main(episodes: Episodes = 64, seed: Seed = 0) -> None:
    """Print the errors of "adaptive" beside those of a smoother of the same episodes."""
    from lab.leaderboard.smoother import compared
    from policies.leaderboard.tables import markdown

    typer.echo(markdown(compared(episodes, seed), 1))
