"""All estimators on the same records."""

from policies.leaderboard.run import run_leaderboard

__all__ = ["run_leaderboard"]
