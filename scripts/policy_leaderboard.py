"""The command `slipgym policy-leaderboard`."""

from policies.commands.policy_leaderboard import app

if __name__ == "__main__":
    app()
