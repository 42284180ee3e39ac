"""Plain-array state of one pad: the record every contact kernel reads and writes."""

from __future__ import annotations

import numpy as np

PAD = np.dtype(
    [
        ("mu_c", "f8"),  # Coulomb friction [-]
        ("mu_s", "f8"),  # static friction [-]
        ("stribeck_velocity", "f8"),  # v_s [m/s]
        ("stribeck_exponent", "f8"),  # gamma [-]
        ("sigma_0", "f8"),  # bristle stiffness per normal force [1/m]
        ("sigma_1", "f8"),  # bristle damping per normal force [s/m]
        ("sigma_2", "f8"),  # viscous friction per normal force [s/m]
        ("r", "f8"),  # radius of the equivalent rim contact; a patch's unit of length [m]
        ("cop", "f8", 2),  # centre of pressure in the pad frame [m]
        ("z", "f8", 3),  # bristle state in the scaled displacement (x, y, r theta) [m]
        ("slip_speed", "f8"),  # scaled slip speed; does not rise in stick [m/s]
        ("slip_rate", "f8"),  # its rate of change [m/s^2]
        ("twist", "f8", 3),  # scaled slip twist of a patch [m/s]
        ("twist_rate", "f8", 3),  # its rate of change [m/s^2]
        ("normal", "f8"),  # normal force [N]
        ("wrench", "f8", 3),  # on the object at the centre of pressure, pad frame [N, N, N m]
    ]
)
"""One pad: parameters of the limit surface, bristle state and last wrench."""

CELL = np.dtype(
    [
        ("x", "f8"),  # position from the centre of pressure over the pad's r [-]
        ("y", "f8"),
        ("share", "f8"),  # of the pad's normal force [-]
        ("z_x", "f8"),  # bristle state [m]
        ("z_y", "f8"),
        ("cap", "f8"),  # slip speed that stick does not exceed; infinite in slip [m/s]
        ("reach", "f8"),  # longest deflection in this step [m]
    ]
)
"""One cell of a patch."""

_STATE = "z", "slip_speed", "slip_rate", "twist", "twist_rate", "wrench", "z_x", "z_y", "cap"


def pads(shape: int | tuple[int, ...], **parameters: float) -> np.ndarray:
    """Return an array of pads at rest, Stribeck exponent 2 unless given.

    Args:
        shape: Shape of the array.
        **parameters: Values of the parameter fields of `PAD`, broadcast over the array.
    """
    array = np.zeros(shape, PAD)
    for name, value in {"stribeck_exponent": 2.0, **parameters}.items():
        array[name] = value
    return array


def patch(positions: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Return cells at rest, shape (n,).

    Args:
        positions: From the centre of pressure, over the pad's r, shape (n, 2) [-].
        shares: Of the normal force, shape (n,), sum 1.
    """
    array = np.zeros(len(shares), CELL)
    array["x"], array["y"] = positions.T
    array["share"] = shares
    return array


def rest(array: np.ndarray) -> None:
    """Bring an array of `PAD` or `CELL` to rest: no deflection, no speed, no wrench."""
    for field in _STATE:
        if field in (array.dtype.names or ()):
            array[field] = 0.0
