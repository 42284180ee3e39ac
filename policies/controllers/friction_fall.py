"""Notices that friction has fallen below its estimate: the object slips in a grip that should hold it.

While nothing slips an estimator learns nothing, so a fall of friction shows only when the object already
moves, mostly after a push. Then force over grip is the present Coulomb friction at once, long before an
estimator that averages has found it. It stays an upper bound of what the controller assumes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

UNBOUNDED = 10.0
"""Bound of friction before any fall [-]."""
MOVING = 2e-3
"""Scaled speed that is slip; one count of one chip reads as 1e-3 m/s [m/s]."""
REST = 8
"""Control steps after a fall in which a late velocity says nothing new."""
CATCH = 2
"""The first of them, in which the grip closes as fast as it can."""
SPRUNG = 1e-4
"""Slip up to which a fall was none: the pads gave, and came back [m]."""
FASTER = 2.0
"""Speed of a fall on such pads, over the fastest at which they gave, at least [-]."""
PUSH = 2.0
"""Rise of the load in a push, over its changes of late, at least [-]; on soft pads it rings after one."""
FADE = 0.9
"""Share of such a change that counts a control step later [-]."""
SPRING = 4e-4
"""Slip beyond what a soft pad springs: 2e-4 m/N under the pushes of a few newtons [m]."""
DEEPEST = 0.4
"""Largest friction to assume after a fall, over that before, at least [-]."""
LEAST_GRIP = 0.2
"""Grip from which force over grip has a meaning [N]."""


class FallState(NamedTuple):
    """Memory, arrays (n,)."""

    bound: np.ndarray  # largest friction to assume [-]
    trusted: np.ndarray  # the same before the present fall, which the measured slip has not confirmed yet [-]
    x: np.ndarray  # measured slip before it, along the pads' x axis [m]
    y: np.ndarray  # the same along their y axis [m]
    load: np.ndarray  # scaled load per finger at the last control step [N]
    swing: np.ndarray  # largest change of the load in a control step, fading [N]
    ratio: np.ndarray  # load over grip at the last control step [-]
    before: np.ndarray  # the same one control step earlier [-]
    speed: np.ndarray  # scaled speed at the last control step [m/s]
    rest: np.ndarray  # control steps left of `REST`
    peak: np.ndarray  # largest scaled speed since the last fall began [m/s]
    give: np.ndarray  # largest scaled speed at which the pads gave without a slip [m/s]


def begin(n: int) -> FallState:
    """Memory of n rows at the start of an episode."""
    return FallState(*np.full((2, n), UNBOUNDED), *np.zeros((10, n)))


def notice(
    state: FallState,
    load: np.ndarray,
    grip: np.ndarray,
    speed: np.ndarray,
    slip: tuple[np.ndarray, np.ndarray],
    assumed: np.ndarray,
    known: np.ndarray,
) -> tuple[np.ndarray, FallState]:
    """Bounds friction where the object slips although the assumed friction should hold it.

    The velocity is a sample or more old, and the object may stick again, with a load over grip that says
    nothing about friction. So of the last three ratios the largest counts. If the velocity then still rises,
    the object was sliding, and the break-away, which static friction makes too large a ratio, is left out. A
    bound lasts if the object has moved further than soft pads spring. Pads that gave and came back are soft:
    from then on only what is faster is a fall.

    Args:
        state: Memory of n rows.
        load: Scaled load per finger (n,) [N].
        grip: Measured normal force per finger (n,) [N].
        speed: Scaled slip speed (n,) [m/s].
        slip: Measured slip along x and y, (n,) each [m].
        assumed: Friction below which the load should stick, (n,) [-].
        known: Where friction is known well enough to be contradicted, (n,) bool.

    Returns:
        Where to close the grip as fast as possible, (n,) bool, and the new memory.
    """
    present = load / np.maximum(grip, LEAST_GRIP)
    ratio = np.maximum(np.maximum(present, state.ratio), state.before)
    moving = np.maximum(MOVING, FASTER * state.give)
    fallen = known & (state.rest == 0.0) & (speed > moving) & (ratio < np.minimum(assumed, state.bound))
    bound = np.where(fallen, np.maximum(ratio, DEEPEST * assumed), state.bound)
    rises = (state.rest == REST) & (speed > state.speed)
    sliding = np.maximum(np.maximum(state.ratio, state.before), DEEPEST * assumed)
    bound = np.where(rises, np.minimum(bound, sliding), bound)
    rest = np.where(fallen, float(REST), np.maximum(state.rest - 1.0, 0.0))
    way = np.hypot(slip[0] - state.x, slip[1] - state.y)
    moved, ends, quiet = way > SPRING, state.rest == 1.0, rest == 0.0
    swing = np.maximum(np.abs(load - state.load), FADE * state.swing)
    peak = np.where(fallen, speed, np.maximum(state.peak, speed))
    give = np.where(ends & (way < SPRUNG), np.maximum(state.give, state.peak), state.give)
    bound = np.where(ends & ~moved, state.trusted, bound)
    trusted = np.where(ends & moved, bound, state.trusted)
    x, y = (np.where(quiet, now, old) for now, old in zip(slip, (state.x, state.y), strict=True))
    return rest > REST - CATCH, FallState(
        bound, trusted, x, y, load, swing, present, state.ratio, speed, rest, peak, give
    )
