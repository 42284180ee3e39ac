"""The command `slipgym leaderboard`."""

from policies.console import run

if __name__ == "__main__":
    run("leaderboard")
