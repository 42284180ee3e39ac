"""Evaluates the estimators in worlds of their own: random pads, motions and sensors, no physics of slipgym.

An estimator that was made with slipgym's episodes may have learned their habits. Nothing here is shared with
`slipgym` or `estimator` but the compiler: contact, body and sensors are written a second time, with other
friction models, other pads and other errors of the sensors. `slipgym fuzz` prints the table.
"""

from lab.worlds.draw import drawn
from lab.worlds.run import errors, table
from lab.worlds.world import Record, simulate

__all__ = ["Record", "drawn", "errors", "simulate", "table"]
