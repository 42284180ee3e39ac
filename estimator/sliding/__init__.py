"""Estimators that learn from each instant of true sliding: what they share."""
