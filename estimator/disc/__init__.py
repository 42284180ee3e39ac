"""The "joint" estimator on the exact limit surface of a uniform disc."""
