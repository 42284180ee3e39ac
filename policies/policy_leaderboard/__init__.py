"""The leaderboard of policies: every task, level and opponent, on the same episodes."""
