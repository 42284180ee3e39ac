"""Measures the speed of the environments, for `slipgym benchmark`; no environment imports it."""
