"""Ranges of counters and indices in estimators' states: a state from outside must keep them."""

from collections.abc import Mapping

from estimator.augmented.timing import EARLIEST, LATEST
from estimator.registry import names
from estimator.stick_slip import BUFFER_CAPACITY

COUNT = 2**36
"""Largest counter: 18 years of samples."""
_COUNTERS = (
    *("samples", "events_mu_s", "updates_mu_c", "updates_r", "still_samples", "changes_mu_s"),
    *("in_a_row", "moved", "above", "in_contact", "age"),
)
_RANGES = {
    **dict.fromkeys(_COUNTERS, (0, COUNT)),
    "buffer_size": (0, BUFFER_CAPACITY),
    "buffer_next": (0, BUFFER_CAPACITY - 1),
    "delay": (EARLIEST, LATEST),
}


def ranges(name: str) -> Mapping[str, tuple[int, int]]:
    """Field of an estimator's state -> smallest and largest value of its whole numbers.

    Args:
        name: Name of the estimator; empty for your own estimators, whose fields only they know.
    """
    return _RANGES if name in names() else {}
