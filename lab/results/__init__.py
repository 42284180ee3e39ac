"""Writes the results of docs/results: each is printed by a declared command.

`make results` runs all of them, `python -m lab.results NAME ...` some. `results.yaml` declares which results
there are, `files.py` what a file consists of, `run.py` runs the commands.
"""

from lab.results.declarations import RESULTS, Result, find
from lab.results.run import run

__all__ = ["RESULTS", "Result", "find", "run"]
