"""Compares the order of mean returns of policies with that of their success rates."""
