"""Reduces a recording to one row of the table of trials."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from policies.evaluation.columns import (
    FORCE,
    OUTCOME,
    ROTATION,
    SLIP,
    Measures,
    Metric,
    Tolerance,
    final_error,
    largest_slip,
    measures_by_motion,
    tracking,
)
from policies.evaluation.recording import Recording
from slipgym.tasks import find


def measure(recording: Recording, task: str) -> dict[str, Any]:
    """Outcome of a trial: the columns common to all tasks, then the task's own."""
    friction = {"true": recording.true, "final": recording.estimated[-1].mean(axis=0)}
    common = {
        "success": bool(recording.success),
        "dropped": bool(recording.dropped),
        "steps": len(recording.time),
        "return": math.fsum(recording.reward.tolist()),
        "mean_force_N": recording.grip_force.mean().item(),
        "max_rotation_deg": math.degrees(np.abs(recording.slip[:, 2]).max()),
    }
    for when, (mu_s, mu_c, r) in friction.items():
        common |= {f"{when}_mu_s": mu_s.item(), f"{when}_mu_c": mu_c.item(), f"{when}_r_mm": 1e3 * r.item()}
    return {**common, **measures(task).measure(recording)}


def measures(task: str) -> Measures:
    """Measures of the trials of a task: its own, or those that follow from its motion and options."""
    found = find(task)
    return MEASURES[found.name] if found.name in MEASURES else measures_by_motion(found)


def measure_linear_slip(recording: Recording) -> dict[str, Any]:
    """Tracking error of the slip along gravity, and mu_c over the cruise."""
    slid = -recording.slip[:, 1]
    error = slid - recording.reference[:, 0]
    cruise = (recording.reference[:, 1] > 0.0) & (recording.reference[:, 2] == 0.0)
    mu_c = recording.estimated[cruise, :, 1]
    return {
        **final_error(1e3 * (slid[-1] - recording.goal).item(), "mm"),
        "rms_error_mm": 1e3 * math.sqrt(np.mean(error**2)),
        "max_sideways_mm": 1e3 * np.abs(recording.slip[:, 0]).max().item(),
        "cruise_mu_c": mu_c.mean().item() if mu_c.size else math.nan,
    }


def measure_rotational_slip(recording: Recording) -> dict[str, Any]:
    """Tracking error of the turn by gravity, and slide of the object meanwhile."""
    turned = -recording.slip[:, 2]
    return {
        **final_error(math.degrees(turned[-1] - recording.goal), "deg"),
        "rms_error_deg": math.degrees(math.sqrt(np.mean((turned - recording.reference[:, 0]) ** 2))),
        "largest_slip_mm": largest_slip(recording),
    }


def measure_hinge(recording: Recording) -> dict[str, Any]:
    """Slide and tilt of the object while the wrist pitched."""
    tilt = recording.slip[:, 2] + recording.reference[:, 0]
    return {
        "largest_slip_mm": largest_slip(recording),
        "largest_tilt_deg": math.degrees(np.abs(tilt).max()),
    }


def measure_planar_slip(recording: Recording) -> dict[str, Any]:
    """Final distance of the object from its target."""
    target, final = recording.reference[-1], recording.slip[-1]
    return {
        "final_error_mm": 1e3 * math.hypot(*(final[:2] - target[:2])),
        **final_error(math.degrees(final[2] - target[2]), "deg"),
        "target_x_mm": 1e3 * target[0].item(),
        "target_y_mm": 1e3 * target[1].item(),
        "target_theta_deg": math.degrees(target[2]),
    }


def measure_hold(recording: Recording) -> dict[str, Any]:
    """Slip of the object, grip force beside the least one, and the mean allowed one; NaN: any is allowed."""
    needed, allowed = recording.needed_force, recording.reference[-1, 0].item()
    force = recording.grip_force.mean(axis=1)
    return {
        "largest_slip_mm": largest_slip(recording),
        "needed_force_mean_N": needed.mean().item(),
        "needed_force_peak_N": needed.max().item(),
        "force_ratio": (force.mean() / needed.mean()).item(),
        "allowed_force_N": allowed or math.nan,
    }


def measure_fragile_hold(recording: Recording) -> dict[str, Any]:
    """Slip of the object, and grip beside the least and the breaking force."""
    limit, least = recording.reference[-1, 0].item(), recording.reference[-1, 1].item()
    force = recording.grip_force.mean(axis=1)
    return {
        "largest_slip_mm": largest_slip(recording),
        "breaking_force_N": limit,
        "least_force_N": least,
        "peak_force_ratio": force.max().item() / limit,
        "force_ratio": force.mean().item() / least,
    }


def measure_carry(recording: Recording) -> dict[str, Any]:
    """Slip of the object, and mean grip beside the least and the allowed one."""
    allowed, least, peak = recording.reference[-1].tolist()
    force = recording.grip_force.mean().item()
    return {
        "largest_slip_mm": largest_slip(recording),
        "allowed_force_N": allowed,
        "least_force_mean_N": least,
        "least_force_peak_N": peak,
        "force_ratio": force / least,
    }


def measure_explore(recording: Recording) -> dict[str, Any]:
    """End of the episode, used share of the budget of slip, and score of the guess."""
    score, regret, used = recording.reference[-1].tolist()
    return {
        "time_s": recording.time[-1].item(),
        "largest_slip_mm": largest_slip(recording),
        "budget_used": used,
        "log_score": score,
        "regret": regret,
    }


def measure_pivot_to(recording: Recording) -> dict[str, Any]:
    """Final error of the object's angle, and its slide."""
    return {
        **final_error(math.degrees(recording.slip[-1, 2] - recording.goal), "deg"),
        "largest_slip_mm": largest_slip(recording),
        "target_theta_deg": math.degrees(recording.goal),
    }


_MM, _SLIDE = Tolerance("tolerance", "tolerance_mm", 1e3), Tolerance("slide_tolerance", "tolerance_mm", 1e3)
_DEG, _TILT, _ANGLE = (
    Tolerance(name, "tolerance_deg", math.degrees(1.0))
    for name in ("tolerance", "tilt_tolerance", "angle_tolerance")
)
_SLIDING = (*tracking("m"), Metric("max_sideways_mm", "largest sideways slip [mm]"))
_TURNING = tracking("rad")
_FINAL, _FINAL_ANGLE = _SLIDING[1], _TURNING[1]
_DISTANCE = Metric("final_error_mm", "final distance to the target [mm]", brief=True)
_TIME = Metric("time_s", "time [s]", brief=True)
_NEEDED = (
    Metric("allowed_force_N", "allowed, mean [N]", brief=True),
    Metric("needed_force_mean_N", "least needed, mean [N]", brief=True),
    Metric("needed_force_peak_N", "least needed, peak [N]"),
    Metric("force_ratio", "grip / least needed"),
)
_BREAKING = Metric("peak_force_ratio", "largest grip / breaking force", brief=True)
_LEAST = Metric("least_force_N", "least force [N]"), Metric("force_ratio", "grip / least force")
_CARRIED = (
    Metric("force_ratio", "mean grip / mean least", brief=True),
    FORCE,
    Metric("least_force_mean_N", "least force, mean [N]"),
    Metric("least_force_peak_N", "least force, peak [N]"),
)
_EXPLORED = (
    _TIME,
    Metric("budget_used", "used share of the budget of slip"),
    Metric("log_score", "log score"),
    Metric("regret", "regret"),
)
_TILTED = Metric("largest_tilt_deg", "largest tilt [°]", brief=True)

MEASURES: dict[str, Measures] = {
    "LinearSlip": Measures(measure_linear_slip, (_MM,), (*OUTCOME, *_SLIDING, ROTATION, FORCE), _FINAL),
    "RotationalSlip": Measures(
        measure_rotational_slip, (_DEG, _SLIDE), (*OUTCOME, *_TURNING, SLIP, FORCE), _FINAL_ANGLE
    ),
    "Hinge": Measures(measure_hinge, (_SLIDE, _TILT), (*OUTCOME, SLIP, _TILTED, FORCE), SLIP),
    "PlanarSlip": Measures(
        measure_planar_slip, (_MM, _ANGLE), (*OUTCOME, _DISTANCE, _FINAL_ANGLE, FORCE), _DISTANCE
    ),
    "Hold": Measures(measure_hold, (_MM,), (*OUTCOME, SLIP, ROTATION, FORCE, *_NEEDED), FORCE),
    "FragileHold": Measures(measure_fragile_hold, (_MM,), (*OUTCOME, SLIP, _BREAKING, FORCE, *_LEAST), SLIP),
    "Carry": Measures(measure_carry, (_MM,), (*OUTCOME, SLIP, *_CARRIED), SLIP),
    "Explore": Measures(measure_explore, (), (*OUTCOME, *_EXPLORED), _TIME),
    "PivotTo": Measures(
        measure_pivot_to, (_SLIDE, _DEG), (*OUTCOME, _FINAL_ANGLE, SLIP, FORCE), _FINAL_ANGLE
    ),
}
"""Task -> its measures, where they are more than `measures` finds by itself."""
