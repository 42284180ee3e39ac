"""Measures the estimators: jumps of friction, late velocities, the cost of an update."""
