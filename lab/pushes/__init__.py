"""Real pushes of a block on known supports, as a test of the estimators (docs/pushes.md)."""

from lab.pushes.extract import EXTRACT, read, read_held_out, write
from lab.pushes.run import run_pushes

__all__ = ["EXTRACT", "read", "read_held_out", "run_pushes", "write"]
