"""Everything the "joint" estimator remembers between two samples."""

import numpy as np
from numpy.typing import NDArray

from estimator.stick_slip.state import STICK_SLIP_STATE

DELAY_MAX = 6
"""Largest velocity_delay: the forces of that time travel inside the state, whose size is fixed."""

FORCES = DELAY_MAX + 2
"""Rows of the ring of forces."""

STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        ("viscosity", np.float64),
        ("information", np.float64, (3,)),
        ("noise", np.float64, (3,)),
        ("vector", np.float64, (2,)),
        ("information_r", np.float64),
        ("noise_r", np.float64),
        ("borrowed", np.float64),
        ("product", np.float64),
        ("product_information", np.float64),
        ("product_noise", np.float64),
        ("elapsed", np.float64),
        ("in_a_row", np.int64),
        ("forces", np.float64, (FORCES, 3)),
        ("twist", np.float64, (3,)),
        ("moved", np.bool_),
    ],
    align=True,
)
"""Weighted sums over samples (1, v) for (mu_c, viscosity): `information` (11, 12, 22), `noise` the same with
squared fading, `vector` the right-hand side; for r, and for `product`, mu_c r [m] of spins before mu_c was known,
alike. `borrowed`: share of r that came by way of mu_c. Last samples: `forces` a ring of (f_t, f_n, |tau|)
[N, N, N m], `twist` the previous one, `moved` whether it was faster than eps_v, `elapsed` its interval [s],
`in_a_row` how many came without a gap."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = np.zeros(len(parameters), STATE)
    states["mu_s"] = parameters["mu_s0"]
    states["mu_c"] = parameters["mu_c0"]
    states["r"] = parameters["r0"]
    weight = 1.0 / parameters["sd_mu_c0"] ** 2
    states["information"][:, 0] = states["noise"][:, 0] = weight
    states["vector"][:, 0] = weight * parameters["mu_c0"]
    states["information_r"] = states["noise_r"] = 1.0 / parameters["sd_r0"] ** 2
    return states
