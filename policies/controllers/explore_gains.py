"""Gains of the controller of Explore."""

from __future__ import annotations

from pydantic import Field

from policies.controllers.gains import Fraction
from slipgym.config.base import Frozen, NonNegative, Positive


class ForceGains(Frozen):
    """Gains of finding friction from forces."""

    sd_force: Positive = Field(default=0.014, description="Noise of the tangential force, both fingers [N]")
    sd_normal: Positive = Field(default=0.028, description="Noise of the normal force, both fingers [N]")
    sd_torque: Positive = Field(default=3.5e-4, description="Noise of the torque, both fingers [N m]")
    follows: NonNegative = Field(
        default=7, description="Control steps after which the normal force follows a falling command [-]"
    )
    smoothing: Positive = Field(
        default=0.25, description="Weight of the newest normal force over command in the smoothed one [-]"
    )
    instant: NonNegative = Field(
        default=1.0,
        description="Control steps from a break-away to the sample in which the force has fallen [-]",
    )
    pushed: Positive = Field(
        default=1.15, description="Force over load in a catch from which the object surely slides [-]"
    )
    pulled: NonNegative = Field(
        default=0.95, description="Force over load before a catch up to which it surely slides [-]"
    )
    aside: NonNegative = Field(
        default=0.25, description="Change of torque over r force in a slide from which it was over [-]"
    )
    least: NonNegative = Field(
        default=0.6, description="mu_c over mu_s at least, below which a slide was over [-]"
    )
    viscous: NonNegative = Field(
        default=0.004,
        description="What viscous friction adds to mu_c in such a slide, 0.2 s/m at 20 mm/s [-]",
    )
    plateau: Positive = Field(
        default=0.75,
        description="Smallest over largest torque of three samples in which the object turns [-]",
    )
    spin: Positive = Field(default=0.3, description="Slip rate that shows that it turns [rad/s]")
    turned: NonNegative = Field(
        default=0.005, description="Measured path of the angle from which r counts as seen [rad]"
    )
    sd_break: NonNegative = Field(
        default=0.015, description="Relative deviation of a break-away's ratio beside noise [-]"
    )
    sd_sample: NonNegative = Field(
        default=0.01, description="Standard deviation of a sample in a slide or turn [-]"
    )
    sd_shared: NonNegative = Field(
        default=0.01, description="Relative deviation of the ratios that all samples share [-]"
    )


class ExploreGains(ForceGains):
    """Gains of `ExplorePolicy`."""

    forces: bool = Field(default=True, description="Whether what forces show counts beside the estimate [-]")
    settle: NonNegative = Field(default=5, description="Control steps in which the load is averaged [-]")
    first: Positive = Field(default=4.0, description="Grip over load from which it is relaxed at first [-]")
    keep: Fraction = Field(default=0.94, description="Fraction of the grip left a control step later [-]")
    again: Positive = Field(
        default=1.2, description="Grip over that of the last slip from which it falls again [-]"
    )
    newest: Fraction = Field(
        default=0.25, description="Weight of the newest force in the load while the grip falls [-]"
    )
    keep_again: Fraction = Field(default=0.98, description="Fraction left a control step later then [-]")
    fall: NonNegative = Field(
        default=0.065, description="Fall of the force that is a slip, over the force [-]"
    )
    noise: NonNegative = Field(default=0.055, description="Fall of the force that is always noise [N]")
    slow: NonNegative = Field(
        default=0.15, description="Fall up to which a slip is caught a control step later, over the force [-]"
    )
    speed: Positive = Field(default=2e-3, description="Speed that is a slip [m/s]")
    pulse: Positive = Field(
        default=4.0, description="Command in the control step of a catch, over the grip [-]"
    )
    catch: Positive = Field(default=1.6, description="Grip after a slip over that before [-]")
    rest: NonNegative = Field(default=5, description="Control steps at it [-]")
    margin: Positive = Field(default=3.0, description="mu_c times grip over load in a turn [-]")
    ready: NonNegative = Field(default=4, description="Control steps until that grip is reached [-]")
    turn: Positive = Field(default=3.0, description="Pitch rate of a turn [rad/s]")
    jerk: Positive = Field(default=1.5, description="Change of it in the first control step [rad/s]")
    push: Positive = Field(default=0.9, description="Change of it in those that follow [rad/s]")
    brake: Positive = Field(default=0.3, description="The same at its end, if the object is to stick [rad/s]")
    coast: NonNegative = Field(default=9, description="Control steps from the begin of a turn to its end [-]")
    gently: Positive = Field(
        default=0.7, description="Change in each control step of a pitch in a firm grip [rad/s]"
    )
    longest: NonNegative = Field(default=60, description="Control steps until it brakes at most [-]")
    lever: NonNegative = Field(default=0.2, description="Torque of the weight over r load that is none [-]")
    slips: NonNegative = Field(default=2, description="Slips at least [-]")
    turns: NonNegative = Field(default=1, description="Turns at least [-]")
    sure: Positive = Field(default=0.025, description="Relative deviation with which a value is known [-]")
    ratio: Positive = Field(default=1.4, description="mu_s over mu_c until mu_c is known [-]")
    slide: NonNegative = Field(default=1.1e-3, description="Path of the slip after which it rests [m]")
    twist: NonNegative = Field(default=0.085, description="Path of the angle that turns may reach [rad]")
