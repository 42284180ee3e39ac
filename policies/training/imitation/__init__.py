"""Imitation of a controller that knows the true friction by a network that does not."""
