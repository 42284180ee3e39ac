"""What only serves slipgym's own pages: the paper's reproduction, the leaderboard, the study, comparisons.

Nothing outside this package imports it, except `scripts/`: none of it is needed to use environments, controllers,
training or evaluation.
"""
