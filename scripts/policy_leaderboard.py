"""The command `slipgym policy-leaderboard`."""

from policies.commands.policy_leaderboard import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
