"""Finds out whether the slip velocity is late: the force falls at once, the velocity shows it later.

A break-away is a fall of the load, as in the leaps (`policies.controllers.leaps`). The time from there until
the measured speed rises is the delay of the velocity, less that of the force. A slip that gets longer than
the reference asks for shows the same: it was caught late.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from policies.controllers import leaps
from policies.controllers.gains import Gain
from policies.controllers.leaps import LeapGains
from slipgym.config.base import Frozen, NonNegative, Positive

RESTS, SHOWN = 0.0, -1.0
"""Of `Lateness.waited`: no break-away since the last rest; the velocity has shown the slip."""


class LatenessGains(Frozen):
    """Gains of deciding that a velocity is late."""

    prompt: NonNegative = Gain(
        0.02, "Time from the fall of the force, after which a velocity that shows it is late [s]"
    )
    seen: Positive = Gain(0.004, "Scaled slip speed that shows a slip; at half of it the object rests [m/s]")
    longest: Positive = Gain(0.0025, "Length of a slip beyond what is asked for, from which it was late [m]")


class Lateness(NamedTuple):
    """Memory, arrays (n,); all 0 at the start."""

    late: np.ndarray  # 1 once the velocity has been late, else 0
    waited: np.ndarray  # control steps since a break-away unseen by the velocity, from 1; or `RESTS`, `SHOWN`
    begun: np.ndarray  # measured distance beyond the reference at the last rest [m]
    load: np.ndarray  # smoothed load per finger at rest [N]
    last: np.ndarray  # load at the last control step [N]
    noise: np.ndarray  # standard deviation of the measured load [N]


def watched(
    past: Lateness,
    load: np.ndarray,
    speed: np.ndarray,
    ahead: np.ndarray,
    gains: LatenessGains,
    slips: LeapGains,
    dt: float,
) -> Lateness:
    """The memory after the present observation.

    Args:
        past: The memory before.
        load: Measured load per finger, (n,) [N].
        speed: Measured scaled slip speed, (n,) [m/s].
        ahead: Measured distance slid, less the reference's, (n,) [m].
        gains: When a velocity is late.
        slips: What a break-away is.
        dt: Control step [s].
    """
    at_rest = np.where(past.load == 0.0, load, past.load)
    rested, fall = past.waited == RESTS, at_rest - load
    least = leaps.break_away(at_rest, past.noise, slips)
    slow = speed < gains.seen
    calm = rested & (fall <= least) & slow
    waited = np.where(past.waited > 0.0, past.waited + 1.0, past.waited)
    waited = np.where(rested & (fall > least) & slow, 1.0, waited)
    back = (past.waited > 0.0) & (fall < 0.5 * least)
    late = ((waited - 1.0) * dt > gains.prompt) & ~back
    late |= ~slow & (ahead - past.begun > gains.longest)
    waited = np.where(~slow, SHOWN, np.where(back, RESTS, waited))
    stops = (past.waited == SHOWN) & (speed < 0.5 * gains.seen)
    noise = leaps.noise_of(load, past.last, at_rest, past.noise, slips)
    at_rest = np.where(calm, leaps.smoothed(at_rest, load), at_rest)
    return Lateness(
        late=np.where(late, 1.0, past.late),
        waited=np.where(stops, RESTS, waited),
        begun=np.where(slow, ahead, past.begun),
        load=np.where(stops, load, at_rest),
        last=load,
        noise=np.where(calm & (past.last > 0.0), noise, past.noise),
    )
