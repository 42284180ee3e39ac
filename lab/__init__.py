"""Serves this project alone: the reproduction, campaigns, comparisons; no wheel has it."""
