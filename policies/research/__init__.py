"""What only serves slipgym's own pages: reproduction of the paper, leaderboard, study, comparisons.

Nothing outside this package imports it, except `scripts/`: environments, controllers, training and evaluation
not need it.
"""
