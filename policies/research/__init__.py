"""Reproduction of the paper, leaderboard and studies: what slipgym's own pages are made with."""
