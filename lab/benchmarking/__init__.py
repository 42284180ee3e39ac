"""Measures what docs/performance.md states: parts of a step, first use, learning."""
