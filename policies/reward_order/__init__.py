"""Whether mean returns of policies have the order of their success rates."""
