"""Plain-array state of one pad: the record every contact kernel reads and writes."""

from __future__ import annotations

import numpy as np

PAD = np.dtype(
    [
        ("mu_c", "f8"),  # Coulomb friction [-]
        ("mu_s", "f8"),  # static friction [-]
        ("stribeck_velocity", "f8"),  # v_s [m/s]
        ("sigma_0", "f8"),  # bristle stiffness per normal force [1/m]
        ("sigma_1", "f8"),  # bristle damping per normal force [s/m]
        ("sigma_2", "f8"),  # viscous friction per normal force [s/m]
        ("r", "f8"),  # radius of the equivalent rim contact [m]
        ("cop", "f8", 2),  # centre of pressure in the pad frame [m]
        ("z", "f8", 3),  # bristle state in the scaled displacement (x, y, r theta) [m]
        ("slip_speed", "f8"),  # scaled slip speed; does not rise in stick [m/s]
        ("slip_rate", "f8"),  # its rate of change [m/s^2]
        ("normal", "f8"),  # normal force [N]
        ("wrench", "f8", 3),  # on the object at the centre of pressure, pad frame [N, N, N m]
    ]
)
"""One pad: parameters of the limit surface, bristle state and last wrench."""


def pads(shape: int | tuple[int, ...], **parameters: float) -> np.ndarray:
    """Return an array of pads at rest.

    Args:
        shape: Shape of the array.
        **parameters: Values of the parameter fields of `PAD`, broadcast over the array.
    """
    array = np.zeros(shape, PAD)
    for name, value in parameters.items():
        array[name] = value
    return array
