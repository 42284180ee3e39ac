"""Measures the speed of the environments, for scripts/benchmark.py; no other module imports it."""
