"""The command `slipgym leaderboard`."""

from policies.commands.leaderboard import app

if __name__ == "__main__":
    app()
