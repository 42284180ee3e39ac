"""The columns that a record can have, and their units."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from estimator.online import TWIST, WRENCH

TIME, VELOCITY_TIME = "t", "velocity_t"
COP = ("cop_x", "cop_y")
TILT = ("tau_x", "tau_y")
GRIP = "grip"
BENCH = ("force", "motion_x", "motion_y", "motion_omega")
"""Grip command and motion of the object against the gripper, which `slipgym identify` reads."""
TRUTH = ("true_mu_s", "true_mu_c", "true_r")
REQUIRED = (TIME, *WRENCH, *TWIST)
ROWS, FINGERS = "rows", "fingers"
"""Keys of a mapping that say which rows are those of the finger, and what differs between fingers."""
OPTIONAL = (*COP, *TILT, *TRUTH, VELOCITY_TIME, GRIP, *BENCH)

_WRITTEN = str.maketrans({"µ": "u", "μ": "u", "°": "deg", **dict.fromkeys(" []()·*.")})
_LONG_SECOND = re.compile(r"sec(ond)?s?$")
_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_FORCE = {"N": 1.0, "mN": 1e-3, "kN": 1e3}
_TORQUE = {"N m": 1.0, "N mm": 1e-3, "mN m": 1e-3, "N cm": 1e-2}
_SPEED = {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "um/s": 1e-6}
_SPIN = {"rad/s": 1.0, "deg/s": math.pi / 180.0, "mrad/s": 1e-3}
_LENGTH = {"m": 1.0, "mm": 1e-3, "cm": 1e-2}
_NUMBER = {"-": 1.0}

UNITS: dict[str, dict[str, float]] = {
    TIME: _SECONDS,
    VELOCITY_TIME: _SECONDS,
    **dict.fromkeys(("f_x", "f_y", "f_n", GRIP), _FORCE),
    **dict.fromkeys(("tau", *TILT), _TORQUE),
    **dict.fromkeys(("v_x", "v_y"), _SPEED),
    "omega": _SPIN,
    **dict.fromkeys(COP, _LENGTH),
    **dict.fromkeys(("true_mu_s", "true_mu_c"), _NUMBER),
    "true_r": _LENGTH,
    "force": dict(_FORCE),  # copies: magnitudes of another kind do not decide these units
    **{key: dict(_SPEED) for key in BENCH[1:3]},
    "motion_omega": dict(_SPIN),
}
"""Key of a mapping -> unit -> factor to SI; the first unit is the default."""
POSITIONS: dict[str, dict[str, float]] = {
    **{key: {**_LENGTH, "um": 1e-6} for key in ("v_x", "v_y")},
    "omega": {"rad": 1.0, "deg": math.pi / 180.0, "mrad": 1e-3},
}
"""Key of a velocity -> units of the displacement that may be given instead."""


def units_of(key: str, position: bool = False) -> dict[str, float]:
    """Unit -> factor to SI, of a key of a mapping or of the displacement that is its position."""
    return (POSITIONS if position else UNITS)[key]


def likely_unit(key: str, size: float, usual: float) -> str:
    """The smaller unit in which a size, too large for the SI unit, is nearest to the usual one in that."""
    smaller = {unit: factor for unit, factor in UNITS[key].items() if factor < 1.0}
    return min(smaller, key=lambda unit: abs(math.log(size * smaller[unit] / usual)))


def unit_of(key: str, texts: Sequence[str], position: bool = False) -> str | None:
    """The unit of a key that a text such as "[Nmm]", "(mm/s)" or "sec" means; None: none of its units."""
    units = {unit.translate(_WRITTEN): unit for unit in units_of(key, position)}
    written = (_LONG_SECOND.sub("s", text.translate(_WRITTEN)) for text in texts)
    return next((units[text] for text in written if text in units), None)


def without_unit(key: str, name: str) -> tuple[str, str] | None:
    """A name such as "vx_mm_s" or "Tz_Nmm" without the unit that it ends with, and the unit; None if none."""
    for unit in units_of(key):
        for over in ("_", "_per_"):
            for space in ("", "_"):
                end = "_" + unit.replace("/", over).replace(" ", space)
                if name.endswith(end) and name != end:
                    return name.removesuffix(end), unit
    return None
