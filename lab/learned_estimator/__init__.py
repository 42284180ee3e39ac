"""Trains the network of the "gru" estimator on simulated episodes; compares it with the other estimators."""
