"""Compares surfaces, estimators and their slip decision with real data of others (docs/real_data.md)."""
