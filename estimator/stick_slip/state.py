"""The state fields that the shared functions need."""

from typing import Any

import numpy as np

from estimator.estimate import COMMON_STATE

BUFFER_CAPACITY = 64
"""Largest n_b: the buffer travels inside the state, whose size is fixed."""

STICK_SLIP_STATE: list[tuple[Any, ...]] = [
    *COMMON_STATE,
    ("support_mu_c", np.float64),
    ("support_r", np.float64),
    ("updates_mu_c", np.int64),
    ("updates_r", np.int64),
    ("events_mu_s", np.int64),
    ("scatter_mu_s", np.float64),
    ("f_n", np.float64),
    ("halt_left", np.float64),
    ("still_samples", np.int64),
    ("buffer_size", np.int64),
    ("buffer_next", np.int64),
    ("buffer", np.float64, (BUFFER_CAPACITY,)),
    ("slipping", np.bool_),
]
"""`scatter_mu_s`: mean square of the changes that events made; `f_n`: the previous sample's [N]; `halt_left`:
rest of a halt [s]; `buffer`: ring of force ratios [-]."""
