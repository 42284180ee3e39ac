"""Sensor records of a friction patch whose slip is prescribed and whose truth is known."""

from slipgym.synthetic.course import Course
from slipgym.synthetic.integration import Trace, integrate
from slipgym.synthetic.sensing import Record, ideal, sense

__all__ = ["Course", "Record", "Trace", "ideal", "integrate", "sense"]
