"""Defines a scenario of an independent world."""

from __future__ import annotations

from dataclasses import dataclass

from lab.worlds.friction import Law

BODY = "leaps", "hinge"
"""Motions of a body between two pads; that of the others is prescribed."""


@dataclass(frozen=True)
class Contact:
    """Friction of both pads."""

    shape: str
    """As `lab.worlds.pad.pad` takes it."""
    mu_c: float
    """Coulomb friction [-]."""
    ratio: float
    """mu_s over mu_c [-]."""
    r: float
    """Radius of the equivalent rim contact [m]."""
    law: Law
    """The other constants; its `reference` is set by the motion."""
    jump: float
    """mu after over before the jump [-]."""
    jump_r: float
    """r after over before it [-]."""

    @property
    def changes(self) -> bool:
        """Whether anything jumps."""
        return self.jump != 1.0 or self.jump_r != 1.0


@dataclass(frozen=True)
class Sensors:
    """What a finger's sensors do to the signals; no estimator gets to know it."""

    rate: int
    """Samples in a second [Hz]."""
    latency: int
    """Age of the velocities [samples]."""
    noise: float
    """White noise over that of the preset "realistic" [-]."""
    count: float
    """Resolution of the displacement; 0: white noise of the velocity in its place [m]."""
    irregular: bool
    """Whether the time between samples changes, by up to a third."""
    jitter: float
    """Fraction of the velocities that come a sample later still [-]."""
    lost: float
    """Fraction of the samples that are lost [-]."""
    sign: int
    """1: the wrench is the friction on the object; -1: the load on the finger."""
    zero: tuple[float, float, float, float]
    """Zero errors of f_x, f_y, f_n, tau [N, N, N, N m]."""
    drift: tuple[float, float]
    """Of the zeros of f_x and f_y [N/s]."""
    tilt: tuple[float, float]
    """Fractions of f_n in f_x and f_y [-]."""
    gain: float
    """Measured over true f_n [-]."""
    cop: tuple[float, float]
    """True less assumed centre of pressure [m]."""


@dataclass(frozen=True)
class Scenario:
    """A record of one finger."""

    seed: int
    """Of all that is drawn."""
    group: str
    """A key of `lab.worlds.draw.GROUPS`."""
    motion: str
    """A key of `lab.worlds.draw.MOTIONS`."""
    contact: Contact
    """Its friction."""
    sensors: Sensors
    """Its sensors."""
    normal: float
    """Mean normal force of a prescribed motion [N]."""
    grip: str
    """Course of the normal force of a prescribed motion: "constant", "steps" or "sine"."""
    opened: bool
    """Whether the record begins with an open gripper."""
    regrasp: bool
    """Whether the gripper opens once more."""
    rest: float
    """Time between two slips of a prescribed motion [s]."""
