"""Argues for the estimators' constants: ablation, jumps, delays, a smoother, the cost of an update."""
