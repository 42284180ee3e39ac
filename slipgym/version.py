"""Holds the version of slipgym."""

__version__ = "0.3.0"
