"""What only serves slipgym's own pages: reproduction of the paper, leaderboard, study, comparisons.

Nothing outside this package imports it, except `scripts/`. Environments, controllers, training and evaluation do
not need it.
"""
