"""Reduces a recording to one row of the table of trials."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from policies.evaluation.by_motion import largest_slip, measures_by_motion
from policies.evaluation.columns import DROPPED, FORCE, ROTATION, SLIP, SUCCESS, Measures, Metric, Tolerance
from policies.evaluation.recording import Recording
from slipgym.tasks import find


def measure(recording: Recording, task: str) -> dict[str, Any]:
    """Outcome of a trial: the columns common to all tasks, then the task's own.

    Args:
        recording: The episode.
        task: As `slipgym.tasks.find` takes it.
    """
    true, final = recording.true, recording.estimated[-1].mean(axis=0)
    common = {
        "success": bool(recording.success),
        "dropped": bool(recording.dropped),
        "steps": len(recording.time),
        "return": math.fsum(recording.reward.tolist()),
        "mean_force_N": recording.grip_force.mean().item(),
        "max_rotation_deg": math.degrees(np.abs(recording.slip[:, 2]).max()),
        "true_mu_s": true[0].item(),
        "true_mu_c": true[1].item(),
        "true_r_mm": 1e3 * true[2].item(),
        "final_mu_s": final[0].item(),
        "final_mu_c": final[1].item(),
        "final_r_mm": 1e3 * final[2].item(),
    }
    return {**common, **measures(task).measure(recording)}


def measures(task: str) -> Measures:
    """Measures of the trials of a task: its own, or those that follow from its motion and options.

    Args:
        task: As `slipgym.tasks.find` takes it.
    """
    found = find(task)
    return MEASURES[found.name] if found.name in MEASURES else measures_by_motion(found)


def measure_linear_slip(recording: Recording) -> dict[str, Any]:
    """Tracking error of the slip along gravity, and mu_c over the cruise."""
    slid = -recording.slip[:, 1]
    error = slid - recording.reference[:, 0]
    final = 1e3 * (slid[-1] - recording.goal).item()
    cruise = (recording.reference[:, 1] > 0.0) & (recording.reference[:, 2] == 0.0)
    mu_c = recording.estimated[cruise, :, 1]
    return {
        "final_error_mm": final,
        "final_error_abs_mm": abs(final),
        "rms_error_mm": 1e3 * math.sqrt(np.mean(error**2)),
        "max_sideways_mm": 1e3 * np.abs(recording.slip[:, 0]).max().item(),
        "cruise_mu_c": mu_c.mean().item() if mu_c.size else math.nan,
    }


def measure_rotational_slip(recording: Recording) -> dict[str, Any]:
    """Tracking error of the turn by gravity, and slide of the object meanwhile."""
    turned = -recording.slip[:, 2]
    final = math.degrees(turned[-1] - recording.goal)
    return {
        "final_error_deg": final,
        "final_error_abs_deg": abs(final),
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
    turn = math.degrees(final[2] - target[2])
    return {
        "final_error_mm": 1e3 * math.hypot(*(final[:2] - target[:2])),
        "final_error_deg": turn,
        "final_error_abs_deg": abs(turn),
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
    final = math.degrees(recording.slip[-1, 2] - recording.goal)
    return {
        "final_error_deg": final,
        "final_error_abs_deg": abs(final),
        "largest_slip_mm": largest_slip(recording),
        "target_theta_deg": math.degrees(recording.goal),
    }


_FINAL = Metric("final_error_abs_mm", "final error, size [mm]", brief=True)
_FINAL_ANGLE = Metric("final_error_abs_deg", "final error, size [°]", brief=True)
_DISTANCE = Metric("final_error_mm", "final distance to the target [mm]", brief=True)
_SLIDE = Tolerance("slide_tolerance", "tolerance_mm", 1e3)

MEASURES: dict[str, Measures] = {
    "LinearSlip": Measures(
        measure_linear_slip,
        (Tolerance("tolerance", "tolerance_mm", 1e3),),
        (
            SUCCESS,
            DROPPED,
            Metric("final_error_mm", "final error, signed [mm]", brief=True),
            _FINAL,
            Metric("rms_error_mm", "rms tracking error [mm]", brief=True),
            Metric("max_sideways_mm", "largest sideways slip [mm]"),
            ROTATION,
            FORCE,
        ),
        _FINAL,
    ),
    "RotationalSlip": Measures(
        measure_rotational_slip,
        (Tolerance("tolerance", "tolerance_deg", math.degrees(1.0)), _SLIDE),
        (
            SUCCESS,
            DROPPED,
            Metric("final_error_deg", "final error, signed [°]", brief=True),
            _FINAL_ANGLE,
            Metric("rms_error_deg", "rms tracking error [°]", brief=True),
            SLIP,
            FORCE,
        ),
        _FINAL_ANGLE,
    ),
    "Hinge": Measures(
        measure_hinge,
        (_SLIDE, Tolerance("tilt_tolerance", "tolerance_deg", math.degrees(1.0))),
        (
            SUCCESS,
            DROPPED,
            SLIP,
            Metric("largest_tilt_deg", "largest tilt [°]", brief=True),
            FORCE,
        ),
        SLIP,
    ),
    "PlanarSlip": Measures(
        measure_planar_slip,
        (
            Tolerance("tolerance", "tolerance_mm", 1e3),
            Tolerance("angle_tolerance", "tolerance_deg", math.degrees(1.0)),
        ),
        (SUCCESS, DROPPED, _DISTANCE, _FINAL_ANGLE, FORCE),
        _DISTANCE,
    ),
    "Hold": Measures(
        measure_hold,
        (Tolerance("tolerance", "tolerance_mm", 1e3),),
        (
            SUCCESS,
            DROPPED,
            SLIP,
            ROTATION,
            FORCE,
            Metric("allowed_force_N", "allowed, mean [N]", brief=True),
            Metric("needed_force_mean_N", "least needed, mean [N]", brief=True),
            Metric("needed_force_peak_N", "least needed, peak [N]"),
            Metric("force_ratio", "grip / least needed"),
        ),
        FORCE,
    ),
    "FragileHold": Measures(
        measure_fragile_hold,
        (Tolerance("tolerance", "tolerance_mm", 1e3),),
        (
            SUCCESS,
            DROPPED,
            SLIP,
            Metric("peak_force_ratio", "largest grip / breaking force", brief=True),
            FORCE,
            Metric("least_force_N", "least force [N]"),
            Metric("force_ratio", "grip / least force"),
        ),
        SLIP,
    ),
    "Carry": Measures(
        measure_carry,
        (Tolerance("tolerance", "tolerance_mm", 1e3),),
        (
            SUCCESS,
            DROPPED,
            SLIP,
            Metric("force_ratio", "mean grip / mean least", brief=True),
            FORCE,
            Metric("least_force_mean_N", "least force, mean [N]"),
            Metric("least_force_peak_N", "least force, peak [N]"),
        ),
        SLIP,
    ),
    "Explore": Measures(
        measure_explore,
        (),
        (
            SUCCESS,
            DROPPED,
            Metric("time_s", "time [s]", brief=True),
            Metric("budget_used", "used share of the budget of slip"),
            Metric("log_score", "log score"),
            Metric("regret", "regret"),
        ),
        Metric("time_s", "time [s]", brief=True),
    ),
    "PivotTo": Measures(
        measure_pivot_to,
        (_SLIDE, Tolerance("tolerance", "tolerance_deg", math.degrees(1.0))),
        (SUCCESS, DROPPED, _FINAL_ANGLE, SLIP, FORCE),
        _FINAL_ANGLE,
    ),
}
"""Task -> its measures, where they are more than `measures` finds by itself."""
