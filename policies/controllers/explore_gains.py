"""Gains of the controller of Explore."""

from __future__ import annotations

from policies.controllers.gains import Fraction, Gain
from slipgym.config.base import Frozen, NonNegative, Positive


class ForceGains(Frozen):
    """Gains of finding friction from forces."""

    sd_force: Positive = Gain(0.014, "Noise of the tangential force, both fingers [N]")
    sd_normal: Positive = Gain(0.028, "Noise of the normal force, both fingers [N]")
    sd_torque: Positive = Gain(3.5e-4, "Noise of the torque, both fingers [N m]")
    follows: NonNegative = Gain(7, "Control steps after which the normal force follows a falling command [-]")
    smoothing: Positive = Gain(0.25, "Weight of the newest normal force over command in the smoothed one [-]")
    instant: NonNegative = Gain(
        1.0, "Control steps from a break-away to the sample with the fallen force [-]"
    )
    pushed: Positive = Gain(1.15, "Force over load in a catch from which the object surely slides [-]")
    pulled: NonNegative = Gain(0.95, "Force over load before a catch up to which it surely slides [-]")
    aside: NonNegative = Gain(0.25, "Change of torque over r force in a slide from which it was over [-]")
    least: NonNegative = Gain(0.6, "mu_c over mu_s at least, below which a slide was over [-]")
    viscous: NonNegative = Gain(
        0.004, "Viscous friction's part of mu_c in such a slide, 0.2 s/m at 20 mm/s [-]"
    )
    plateau: Positive = Gain(0.75, "Smallest over largest torque of three samples while the object turns [-]")
    spin: Positive = Gain(0.3, "Slip rate that shows that it turns [rad/s]")
    turned: NonNegative = Gain(0.005, "Measured path of the angle from which r counts as seen [rad]")
    sd_break: NonNegative = Gain(0.015, "Relative deviation of a break-away's ratio beside noise [-]")
    sd_sample: NonNegative = Gain(0.01, "Standard deviation of a sample in a slide or turn [-]")
    sd_shared: NonNegative = Gain(0.01, "Relative deviation of the ratios that all samples share [-]")


class ExploreGains(ForceGains):
    """Gains of `ExplorePolicy`."""

    forces: bool = Gain(True, "Whether what forces show counts beside the estimate [-]")
    settle: NonNegative = Gain(5, "Control steps in which the load is averaged [-]")
    first: Positive = Gain(4.0, "Grip over load from which it is relaxed at first [-]")
    keep: Fraction = Gain(0.94, "Fraction of the grip left a control step later [-]")
    again: Positive = Gain(1.2, "Grip over that of the last slip from which it falls again [-]")
    newest: Fraction = Gain(0.25, "Weight of the newest force in the load while the grip falls [-]")
    keep_again: Fraction = Gain(0.98, "Fraction left a control step later then [-]")
    fall: NonNegative = Gain(0.065, "Fall of the force that is a slip, over the force [-]")
    noise: NonNegative = Gain(0.055, "Fall of the force that is always noise [N]")
    slow: NonNegative = Gain(0.15, "Fall over force up to which a slip is caught a control step later [-]")
    speed: Positive = Gain(2e-3, "Speed that is a slip [m/s]")
    pulse: Positive = Gain(4.0, "Command in the control step of a catch, over the grip [-]")
    catch: Positive = Gain(1.6, "Grip after a slip over that before [-]")
    rest: NonNegative = Gain(5, "Control steps at it [-]")
    margin: Positive = Gain(3.0, "mu_c times grip over load in a turn [-]")
    ready: NonNegative = Gain(4, "Control steps until that grip is reached [-]")
    turn: Positive = Gain(3.0, "Pitch rate of a turn [rad/s]")
    jerk: Positive = Gain(1.5, "Change of it in the first control step [rad/s]")
    push: Positive = Gain(0.9, "Change of it in those that follow [rad/s]")
    brake: Positive = Gain(0.3, "The same at its end, if the object is to stick [rad/s]")
    coast: NonNegative = Gain(9, "Control steps from the begin of a turn to its end [-]")
    gently: Positive = Gain(0.7, "Change in each control step of a pitch in a firm grip [rad/s]")
    longest: NonNegative = Gain(60, "Control steps until it brakes at most [-]")
    lever: NonNegative = Gain(0.2, "Torque of the weight over r load that is none [-]")
    slips: NonNegative = Gain(2, "Slips at least [-]")
    turns: NonNegative = Gain(1, "Turns at least [-]")
    sure: Positive = Gain(0.025, "Relative deviation with which a value is known [-]")
    ratio: Positive = Gain(1.4, "mu_s over mu_c until mu_c is known [-]")
    slide: NonNegative = Gain(1.1e-3, "Path of the slip after which it rests [m]")
    twist: NonNegative = Gain(0.085, "Path of the angle that turns may reach [rad]")
