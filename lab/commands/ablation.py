"""Prints what each state and each test of "adaptive" is worth: without it, on the leaderboard's records."""

import typer

from lab.commands.options import Quick, Seed, application

EPILOG = """
Examples:\n
\b
  slipgym ablation --quick
"""
app = application()


@app.command(epilog=EPILOG)
def main(quick: Quick = False, seed: Seed = 0) -> None:
    """Print what the records' errors become without each state and test of "adaptive"."""
    from lab.leaderboard.ablation import ablation, worth
    from policies.leaderboard.scenarios import effort_of
    from policies.leaderboard.tables import markdown

    typer.echo(markdown(worth(ablation(effort_of(quick, seed))), 2))
