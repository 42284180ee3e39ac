"""Generates sensor records of a friction patch with prescribed slip and known ground truth.

Twenty fingers see 2 s of sliding; they differ by their noise:

    course = Course.start(mu_c=0.4).to("stick", 0.2).to("slide", 0.1, v_x=0.02).to("slide", 2.0)
    record = sense(integrate(course), m=20)
"""

from slipgym.synthetic.course import Course
from slipgym.synthetic.integration import Trace, integrate
from slipgym.synthetic.sensing import Record, ideal, sense

__all__ = ["Course", "Record", "Trace", "ideal", "integrate", "sense"]
