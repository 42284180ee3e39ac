"""The command `slipgym policy-leaderboard`."""

from policies.console import run

if __name__ == "__main__":
    run("policy_leaderboard")
