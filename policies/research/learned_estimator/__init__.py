"""Trains the network of the "gru" estimator on simulated episodes, and compares it with the other estimators."""
