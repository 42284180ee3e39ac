"""Serves this project alone: the reproduction, ablations, campaigns, comparisons; no wheel has it."""
