"""Active exploration: lets the object slip a little so that the estimator learns its friction.

An object that never slips teaches an estimator nothing. The exploration lowers the grip until the object
slips by a tenth of a millimetre or two, and catches it.

**Catching.** When a load L slips, friction carries L mu_c / mu_s of it: the object falls with
a = g (1 - mu_c / mu_s), 2.5 m/s^2 at a ratio of 1.35. The slip velocity arrives up to two control steps late,
17 ms, in which a slip grows to a millimetre and more; but the tangential force drops by a quarter at once,
which is read at the next control step. The wait for it (4 ms in the mean), the dead time (4 ms) and the rise
of the force by the ratio (under 1 ms at the gripper's largest command) make 9 ms, 0.1 mm; the braking adds a
third.

**Rocking.** In every other control step the command is twice the level, in between less than half of it. At a
lag of 12 ms the force then swings between 0.9 and 1.5 levels and comes back by itself while a slip begins,
which about halves the slip of a smooth ramp. An estimator learns from a slip that reaches from one window
of the slip sensor into the next. The shortest do not, so the exploration goes on until it has learnt.

**What it shows by itself.** The largest load over normal force is about mu_s if the object slipped, and less
than that if the smallest grip holds a light object. mu_c follows from it by an assumed ratio of mu_s to mu_c;
where the true one is far larger, Hinge drops objects. It counts beside uncertain estimates. Without an
estimate it takes the place of the assumed friction: in Hinge, which drops by too loose a grip, always; in
Hold, which fails by too firm a one, only if it is larger.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from policies.controllers.base import Columns
from policies.controllers.friction_fall import LEAST_GRIP
from policies.controllers.sensing import relative
from policies.controllers.slip_memory import combined, weight_of

RATIO = 1.3  # mu_s over mu_c, that of the estimators' start values
DEVIATION = 0.15  # Of held / RATIO from mu_c, relative: 0.11 by ratios from 1.1 to 1.6, the rest by sensors
_OPEN = {"slips": (0, np.inf), "keep": (0, 1), "low": (0, 1), "high": (1, np.inf), "catch": (1, np.inf)}


class ExplorationState(NamedTuple):
    """Memory of an exploration, arrays (n,)."""

    load: np.ndarray  # smoothed load per finger [N]
    slips: np.ndarray  # slips caught so far
    rest: np.ndarray  # control steps that the grip still rests after a slip
    high: np.ndarray  # whether the last command of an exploration was the high one, 0 or 1
    held: np.ndarray  # largest load over normal force while friction was unknown [-]

    def holding(self, load: np.ndarray, normal: np.ndarray, unknown: np.ndarray) -> ExplorationState:
        """The memory after another observation: load and normal force per finger, (n,) each [N].

        It counts where friction is unknown.
        """
        counts, ratio = unknown & (normal > LEAST_GRIP), load / np.maximum(normal, LEAST_GRIP)
        return self._replace(held=np.where(counts, np.maximum(self.held, ratio), self.held))

    def corrected(self, mu_c: np.ndarray, columns: Columns, least: np.ndarray | float = 0.0) -> np.ndarray:
        """Friction by an estimate and by what held, the more certain one with more weight, (n,).

        Args:
            mu_c: By the estimate, or assumed where there is none, (n,) [-].
            columns: n observations.
            least: Without an estimate what held counts if it is larger than this [-].
        """
        shown, spread = self.held / RATIO, relative(columns, "mu_c", columns["mu_c"])
        both = combined(mu_c, shown, weight_of(shown, spread, DEVIATION))
        alone = np.where(shown > least, shown, mu_c)
        return np.where(columns["confidence_mu_c"] > 0.0, both, alone)


@dataclass(frozen=True)
class ActiveExploration:
    """Exploration of unknown friction by a controller.

    Raises:
        ValueError: A value is out of range.
    """

    slips: int = 8
    """Slips to provoke at most; an estimator that has learnt from none of them does not get another."""
    keep: float = 0.95
    """Fraction of the level that is left a control step later, in (0, 1)."""
    low: float = 0.4
    """Command over level in every other control step, in (0, 1)."""
    high: float = 2.0
    """Command over level in the control steps between, > 1."""
    fall: float = 0.08
    """Fall of the load that is a slip, over the smoothed load and at least in newtons."""
    speed: float = 2e-3
    """Scaled speed that is a slip [m/s]."""
    smoothing: float = 0.4
    """Weight of the present load in the smoothed one, in (0, 1]."""
    catch: float = 1.6
    """Level after a slip over that at which it happened, > 1."""
    rest: int = 5
    """Control steps at that level, while sensor and estimator follow: latency, two windows, one more."""

    def __post_init__(self) -> None:
        """Check the ranges."""
        for field in fields(self):
            value = getattr(self, field.name)
            low, high = _OPEN.get(field.name, (0, np.inf))
            if not low < value < high:
                raise ValueError(
                    f"{field.name} = {value!r} of an exploration must lie in ({low:g}, {high:g})"
                )
        if self.smoothing > 1.0:
            raise ValueError(f"smoothing = {self.smoothing!r} of an exploration must be at most 1")

    def act(
        self,
        state: ExplorationState,
        level: np.ndarray,
        load: np.ndarray,
        speed: np.ndarray,
        begun: np.ndarray,
        unknown: np.ndarray,
        limits: tuple[float, float],
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, ExplorationState]:
        """One control step of exploration where friction is unknown, and of the rest after a slip.

        Args:
            state: Memory of n rows.
            level: Grip that the exploration varies, (n,) [N].
            load: Load per finger, (n,) [N].
            speed: Scaled slip speed, (n,) [m/s].
            begun: Whether it is not the first control step, (n,); only then it explores.
            unknown: Whether to explore, (n,).
            limits: The smallest and the largest command [N]. What the smallest holds is not explored further.

        Returns:
            Which rows the exploration commands (n,), their commands and levels (n,) [N], and the new memory.
        """
        smooth = np.where(begun, state.load, load)
        slips = (smooth - load > self.fall * np.maximum(smooth, 1.0)) | (speed > self.speed)
        resting = state.rest > 0
        exploring = begun & unknown & ~resting & (state.slips < self.slips)
        caught, ramp = exploring & slips, exploring & ~slips
        high = np.where(ramp, 1.0 - state.high, 1.0)
        level = np.where(ramp, self.keep * level, np.where(caught, self.catch * level, level))
        command = np.where(ramp, np.where(high > 0.0, self.high, self.low) * level, level)
        rest = np.where(caught, self.rest, np.maximum(state.rest - 1, 0))
        held = ramp & (self.high * level <= limits[0])
        smooth = smooth + self.smoothing * (load - smooth)
        slips = np.where(held, self.slips, state.slips + caught)
        memory = ExplorationState(smooth, slips, rest, high, state.held)
        return exploring | resting, np.where(caught, limits[1], command), level, memory
