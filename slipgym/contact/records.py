"""State of the pads as plain arrays: the records that the contact kernels read and write."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.fields import comparison, joined, reset

PAD_FIXED = np.dtype(
    [
        ("surface", "i8"),  # limit surface of a pad without cells: ELLIPSOID or DISC
        ("stribeck_exponent", "f8"),  # gamma [-]
        ("sigma_1", "f8"),  # bristle damping per normal force [s/m]
        ("sigma_2", "f8"),  # viscous friction per normal force [s/m]
        # of `slipgym.contact.soft_pad`
        ("reference_force", "f8"),  # normal force at which mu_c, mu_s and r hold [N]
        ("radius_max", "f8"),  # largest r [m]
        ("shear_time", "f8"),  # damping of the rubber over its stiffness [s]
        ("creep_time", "f8"),  # time constant of `creep` [s]
        ("aging_time", "f8"),  # dwell time at which aging begins [s]
        ("aging_distance", "f8"),  # slip after which it is lost [m]
    ]
)
"""Parameters that the configuration fixes for all episodes."""
PAD_EPISODE = np.dtype(
    [
        ("mu_c", "f8"),  # Coulomb friction, at the reference force [-]
        ("mu_s", "f8"),  # static friction, at the reference force and just after a slip [-]
        ("stribeck_velocity", "f8"),  # v_s [m/s]
        ("speed_slope", "f8"),  # growth of mu_c per e-fold of the slip speed [-]
        ("sigma_0", "f8"),  # bristle stiffness per normal force [1/m]
        ("r", "f8"),  # radius of the equivalent rim contact, at the reference force [m]
        ("cop", "f8", 2),  # centre of pressure in the pad frame, without tangential load [m]
        ("axes", "f8", 2),  # friction along the pad's x and y over its mean [-]
        # of `slipgym.contact.soft_pad`; 0 switches an effect off
        ("load_exponent", "f8"),  # friction falls with the normal force to the power of this, or rises [-]
        ("radius_exponent", "f8"),  # r grows with it [-]
        ("cop_lever", "f8"),  # shift of the centre of pressure over tangential by normal force [m]
        ("compliance", "f8"),  # tangential compliance of the rubber [m/N]
        ("creep", "f8"),  # fraction of its stiffness that relaxes [-]
        ("aging", "f8"),  # growth of mu_s - mu_c per e-fold of dwell time [-]
    ]
)
"""Parameters that an episode may have of its own; disturbances change the friction."""
PAD_PARAMETERS = joined(PAD_FIXED, PAD_EPISODE)
PAD_STATE = np.dtype(
    [
        ("normal", "f8"),  # normal force [N]
        ("friction_scale", "f8"),  # of mu_c and mu_s, from the normal force [-]
        ("static_gain", "f8"),  # of mu_s - mu_c, from the dwell time [-]
        ("radius", "f8"),  # of the equivalent rim contact, a patch's unit of length [m]
        ("pressure_centre", "f8", 2),  # in the pad frame [m]
        ("z", "f8", 3),  # bristle state in the scaled displacement (x, y, r theta) [m]
        ("slip_speed", "f8"),  # scaled slip speed; does not rise in stick [m/s]
        ("slip_rate", "f8"),  # its rate of change [m/s^2]
        ("half_step", "f8"),  # half of the last sub-step: speed and twist are means, those of its middle [s]
        ("twist", "f8", 3),  # scaled slip twist of a patch [m/s]
        ("twist_rate", "f8", 3),  # its rate of change [m/s^2]
        ("wrench", "f8", 3),  # on the object at the centre of pressure, pad frame [N, N, N m]
        ("shear", "f8", 3),  # scaled displacement of the rubber's surface against the finger [m]
        ("relaxed", "f8", 3),  # the part of it to which the relaxing stiffness has come [m]
        ("shear_rate", "f8", 3),  # of a pad without cells, mean of the last sub-step [m/s]
        ("dwell", "f8"),  # age of the contact [s]
        ("aged", "f8"),  # dwell time for which `static_gain` was computed [s]
        ("turn", "f8"),  # position on the disc's curve
        ("elastic_limit", "f8"),  # longest deflection g / sigma_0 in the last sub-step [m]
        ("load_anchor", "f8", 4),  # normal force, friction scale, radius about which both are expanded; r
    ]
)
"""What a sub-step finds of those before."""
PAD_SCRATCH = np.dtype(
    [
        ("prepared", "f8"),  # length of the sub-step that the next four belong to [s]
        ("ahead", "f8"),  # distance of its end from its middle, over that of its middle from the last one's
        ("give", "f8"),  # compliance of the rubber within this sub-step [m/N]
        ("recall", "f8", 3),  # weights of `shear`, `relaxed` [-] and `shear_rate` [s] in its force over that
        ("relaxing", "f8"),  # fraction of the way to `shear` that `relaxed` goes in this sub-step [-]
        # of `slipgym.contact.soft_kernel`: coefficients of this sub-step, see `slipgym.contact.bristle`
        ("loaded", "f8", 3),  # normal force [N], sub-step [s] and `give` that they belong to
        ("stiffness", "f8", 3),  # elastic, damping and viscous force per displacement [N/m]
        ("softer", "f8", 2),  # 1 / (1 + give (E + V)) and 1 / (1 + give V) [-]
        # and results for the displacement that was evaluated last
        ("friction", "f8", 3),  # opposing it, scaled [N]
        ("mapped", "f8", 3),  # bristle state after it [m]
        ("slip", "f8", 3),  # what of it is slip, scaled [m]
        ("stuck", "i8"),  # whether the bristles stick
    ]
)
"""What a sub-step computes from parameters and state before it reads it: it may differ where these agree."""
PAD = joined(PAD_PARAMETERS, PAD_STATE, PAD_SCRATCH)
"""One pad."""
same_pads = comparison(
    "same_pads",
    (PAD_PARAMETERS, PAD_STATE),
    __file__,
    "Whether two pads have the same parameters and state: they then do the same under the same motion.",
)

ELLIPSOID, DISC = 0, 1
"""Limit surfaces of a pad without cells."""

Pad: TypeAlias = Any
"""A record of `PAD`. Compiled code reads its fields as attributes, which numpy's types do not describe."""
Pads: TypeAlias = Any
"""Records of `PAD`, as an array or as a tuple."""
Cells: TypeAlias = np.ndarray
"""Cells of one pad's patch, (CELL_FIELDS, n)."""
Pair: TypeAlias = tuple[float, float]
"""Two numbers (x, y)."""
Vector: TypeAlias = tuple[float, float, float]
"""A scaled vector (x, y, r theta), or a motion (x, y, theta)."""
Symmetric: TypeAlias = tuple[float, float, float, float, float, float]
"""A symmetric 3 x 3 matrix (xx, yy, tt, xy, xt, yt)."""

X, Y = 0, 1
"""Position of a cell from the centre of pressure over the pad's r [-]."""
LOAD = 2
"""Fraction of the pad's normal force that a cell carries [-]."""
Z_X, Z_Y = 3, 4
"""Bristle state of a cell [m]."""
SPEED_CAP = 5
"""Slip speed of a cell that stick does not exceed; infinite in slip [m/s]."""
ELASTIC_LIMIT = 6
"""Longest deflection of a cell's bristle in this step [m]."""
RETENTION = 7
"""Fraction of its deflection that a cell's bristle has kept in this step's friction level [-]."""
SHEAR_X, SHEAR_Y = 8, 9
"""Displacement of the rubber's surface at a cell against the finger [m]."""
RELAXED_X, RELAXED_Y = 10, 11
"""The part of it to which the relaxing stiffness has come [m]."""
CELL_FIELDS = 12
"""Rows of a patch, an array (CELL_FIELDS, n): one quantity in a row lets loops over n cells vectorise."""
CELL_PARAMETERS = LOAD + 1
"""The first so many are parameters, the others state, but for ELASTIC_LIMIT, which is scratch."""


CONFIGURED = {"shear_compliance": "compliance"}
"""Name in `slipgym.config.pad` -> name in `PAD_PARAMETERS`, where they differ."""
NEUTRAL: dict[str, float] = {
    "stribeck_exponent": 2.0,
    "axes": 1.0,
    "reference_force": 5.0,
    "radius_max": np.inf,
    "creep_time": 1.0,
    "aging_time": 1.0,
    "aging_distance": 1.0,
}
"""Parameters of a pad that are not 0 unless given."""


def pads(shape: int | tuple[int, ...], **parameters: float) -> np.ndarray:
    """Return an array of pads at rest: ellipsoids, Stribeck exponent 2, hard and even, unless given.

    Args:
        shape: Shape of the array.
        **parameters: Values of fields of `PAD_PARAMETERS`, broadcast over the array.
    """
    array = np.zeros(shape, PAD)
    for name, value in {**NEUTRAL, **parameters}.items():
        array[name] = value
    rest(array.reshape(-1))
    return array


def patch(positions: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Cells at rest, (CELL_FIELDS, n), of positions (n, 2) over the pad's r and loads (n,), sum 1 [-]."""
    cells = np.zeros((CELL_FIELDS, len(loads)))
    cells[X], cells[Y] = positions.T
    cells[LOAD] = loads
    cells[RETENTION] = 1.0
    return cells


_STARTS = {
    "normal": "record.normal",  # the fingers set it
    "friction_scale": "1.0",
    "static_gain": "1.0",
    "radius": "record.r",
    "pressure_centre[0]": "record.cop[0]",
    "pressure_centre[1]": "record.cop[1]",
    "turn": "0.5",
}
_rest_pad = reset(
    "_rest_pad", (PAD_STATE, PAD_SCRATCH), _STARTS, __file__, "Bring a pad to rest, see `rest`."
)


@compiled
def rest(pads: np.ndarray) -> None:
    """Bring pads, an array (n,) of `PAD`, to rest: no deflection, no speed, no wrench."""
    for i in range(pads.shape[0]):
        _rest_pad(pads[i])


@compiled
def idle(row: int, pad: Pad) -> bool:
    """Whether a row of a patch may differ where pads are the same: it is scratch, or 0 on rigid pads."""
    return row == ELASTIC_LIMIT or (pad.compliance == 0.0 and SHEAR_X <= row <= RELAXED_Y)


@compiled
def same_patches(cells: np.ndarray, pad: Pad) -> bool:
    """Whether the patches (2, CELL_FIELDS, n) of pads like `pad` have the same parameters and state."""
    differ = 0
    for row in range(cells.shape[1]):
        if not idle(row, pad):
            for i in range(cells.shape[2]):
                differ += cells[0, row, i] != cells[1, row, i]
    return differ == 0


@compiled
def copy_patch_state(cells: np.ndarray, pad: Pad) -> None:
    """Copy the state of the first of two patches that are the same, see `same_patches`, to the second."""
    if cells.ndim == 3:  # patches, not (2, 0)
        for row in range(CELL_PARAMETERS, cells.shape[1]):
            if not idle(row, pad):
                cells[1, row] = cells[0, row]


@compiled
def rest_cells(cells: np.ndarray) -> None:
    """Bring cells (..., CELL_FIELDS, n) to rest: no deflection, no speed."""
    for row in (Z_X, Z_Y, SPEED_CAP, SHEAR_X, SHEAR_Y, RELAXED_X, RELAXED_Y):
        cells[..., row, :] = 0.0
    cells[..., RETENTION, :] = 1.0
