"""The command `slipgym leaderboard`."""

from policies.commands.leaderboard import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
