"""Real pushes of a block on known supports, as a test of the estimators (docs/pushes.md)."""

from policies.research.pushes.extract import EXTRACT, read, read_held_out, write
from policies.research.pushes.run import run_pushes

__all__ = ["EXTRACT", "read", "read_held_out", "run_pushes", "write"]
