"""Defines what truly happens at a finger: the trace of a simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from slipgym._numba.compiled import compiled

COLUMNS = 13
"""Twist 3, normal force, friction on the object 3, slip 3, mu_c, mu_s, r; see `Trace`."""


@dataclass(frozen=True)
class Trace:
    """What one finger truly feels and sees, at each of n steps."""

    rate: int
    """Steps in a second [Hz]."""
    values: NDArray[np.float64]
    """(n, COLUMNS)."""
    marks: list[float]
    """Times at which estimates are evaluated [s]."""
    jump: float
    """Time at which friction jumps [s]."""

    @property
    def twist(self) -> NDArray[np.float64]:
        """v_x, v_y, omega of the object against the finger, springs among it, (n, 3) [m/s, m/s, rad/s]."""
        return self.values[:, :3]

    @property
    def normal(self) -> NDArray[np.float64]:
        """Normal force, (n,) [N]."""
        return self.values[:, 3]

    @property
    def friction(self) -> NDArray[np.float64]:
        """f_x, f_y, tau on the object, (n, 3) [N, N, N m]."""
        return self.values[:, 4:7]

    @property
    def slip(self) -> NDArray[np.float64]:
        """The twist without that of springs and bristles, (n, 3) [m/s, m/s, rad/s]."""
        return self.values[:, 7:10]

    @property
    def truth(self) -> NDArray[np.float64]:
        """mu_c, mu_s, r at the present load, (n, 3) [-, -, m]."""
        return self.values[:, 10:13]


@compiled
def keep(row, twist, here, out):
    """Writes a row (COLUMNS,) of a trace; the arguments are those of `lab.worlds.friction.friction`."""
    row[0], row[1], row[2], row[3] = twist[0], twist[1], twist[2], here[0]
    for k in range(6):
        row[4 + k] = out[k]
    row[10], row[11], row[12] = here[1], here[2], here[3]
