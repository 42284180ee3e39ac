"""Holds the version of slipgym."""

__version__ = "0.2.0"
