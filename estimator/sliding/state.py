"""The state fields of estimators that learn from each instant of true sliding."""

from typing import Any

import numpy as np

from estimator.stick_slip.state import STICK_SLIP_STATE

DELAY_MAX = 6
"""Largest velocity_delay: the forces of that time travel inside the state, whose size is fixed."""

FORCES = DELAY_MAX + 2
"""Rows of the ring of forces."""

SLIDING_STATE: list[tuple[Any, ...]] = [
    *STICK_SLIP_STATE,
    ("elapsed", np.float64),
    ("in_a_row", np.int64),
    ("forces", np.float64, (FORCES, 3)),
    ("twist", np.float64, (3,)),
    ("moved", np.bool_),
]
"""Last samples: `forces` a ring of (f_t, f_n, |tau|) [N, N, N m], `twist` the previous one and whether it
`moved`, `elapsed` its interval [s], `in_a_row` how many came without a gap."""
