"""Declares and writes the group "privileged": what no robot measures, for critics and teachers."""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym._numba.fixed import opened
from slipgym.config import Config
from slipgym.envs.observation import FRICTION, FRICTION_COLUMNS
from slipgym.envs.readings import Reading, of_state, row_writer
from slipgym.envs.sensor_part import either_way, grip_force
from slipgym.tasks.task import Column


def _pad_friction(config: Config) -> float:
    """Bound of one pad's friction, at the largest friction coefficient [N]."""
    return FRICTION_COLUMNS[0].high * config.gripper.force_limit


_BIAS = either_way(lambda config: config.sensors.force_torque.force_range)
_FRICTION = either_way(_pad_friction)
_TORQUE = either_way(lambda config: _pad_friction(config) * config.gripper.pad_radius)


def _pad(f: int) -> tuple[Reading, ...]:
    wrench, of = f"pads[i, {f - 1}].wrench", f"friction of pad {f} on the object, pad frame"
    return (
        Reading(f"friction_x_{f}", _FRICTION, "N", of, f"{wrench}[0]"),
        Reading(f"friction_y_{f}", _FRICTION, "N", "the same along the pad's y axis", f"{wrench}[1]"),
        Reading(f"friction_tau_{f}", _TORQUE, "N m", f"friction torque at pad {f}'s CoP", f"{wrench}[2]"),
    )


def _grip(name: str, meaning: str) -> Reading:
    return Reading(name, grip_force, "N", f"{meaning}, 0: the task has none", f"episodes[i].{name}")


def _drawn(name: str, most: float, unit: str, meaning: str, field: str = "") -> Reading:
    """A parameter that both pads have in common."""
    return Reading(name, (-most, most), unit, meaning, f"pads[i, 0].{field or name}")


def _own(f: int) -> tuple[Reading, ...]:
    """Parameters of finger 1 or 2 that an episode draws."""
    pad, finger, sensor = f"pads[i, {f - 1}].", f"fingers[i, {f - 1}].", f"force_torque[i, {f - 1}]."
    slip, of = f"slip_sensors[i, {f - 1}].", f"of finger {f}"
    return (
        Reading(f"mu_s_{f}", (0.0, 10.0), "-", f"static friction of pad {f}, reference force", f"{pad}mu_s"),
        Reading(f"r_{f}", (0.0, 1.0), "m", f"contact radius of pad {f}, reference force", f"{pad}r"),
        Reading(f"cop_x_{f}", (-0.1, 0.1), "m", f"centre of pressure of pad {f}, unloaded", f"{pad}cop[0]"),
        Reading(f"cop_y_{f}", (-0.1, 0.1), "m", "the same along the pad's y axis", f"{pad}cop[1]"),
        Reading(f"force_gain_{f}", (0.0, 10.0), "-", f"actuator over commanded force {of}", f"{finger}gain"),
        Reading(f"lag_{f}", (0.0, 10.0), "s", f"time constant of the force loop {of}", f"{finger}lag"),
        Reading(f"bias_x_{f}", _BIAS, "N", f"bias of the force sensor {of}, its frame", f"{sensor}bias[0]"),
        Reading(f"bias_y_{f}", _BIAS, "N", "the same along its y axis", f"{sensor}bias[1]"),
        Reading(f"bias_n_{f}", _BIAS, "N", "the same along the normal", f"{sensor}bias[2]"),
        Reading(f"bias_tau_{f}", (-10.0, 10.0), "N m", "the same about the normal", f"{sensor}bias[5]"),
        Reading(f"wrench_delay_{f}", (0.0, 10.0), "s", f"latency of the force sensor {of}",
                f"{sensor}delay * worlds[i].tick_length"),
        Reading(f"slip_delay_{f}", (0.0, 10.0), "s", f"latency of the slip sensor {of}",
                f"{slip}delay * {slip}sample_time"),
        Reading(f"slip_scale_{f}", (0.0, 10.0), "-", f"counted over true slip {of}", f"{slip}scale"),
    )  # fmt: skip


PRIVILEGED = (
    *(row._replace(read=f"ground_truth[i, {k}]") for k, row in enumerate(FRICTION[:3])),
    Reading("slip_x", (-1.0, 1.0), "m", "slip displacement since the grasp, pad frame", "worlds[i].slip[0]"),
    Reading("slip_y", (-1.0, 1.0), "m", "the same along the pad's y axis", "worlds[i].slip[1]"),
    Reading("slip_theta", (-10.0, 10.0), "rad", "the same about the grip axis", "worlds[i].slip[2]"),
    Reading("slip_velocity_x", (-10.0, 10.0), "m/s", "slip velocity at the pad centre",
            "worlds[i].slip_twist[0]"),
    Reading("slip_velocity_y", (-10.0, 10.0), "m/s", "the same along the pad's y axis",
            "worlds[i].slip_twist[1]"),
    Reading("slip_rate", (-100.0, 100.0), "rad/s", "the same about the grip axis", "worlds[i].slip_twist[2]"),
    *_pad(1),
    *_pad(2),
    Reading("object_x", (-10.0, 10.0), "m", "the object's centre of mass along world x", "worlds[i].com[0]"),
    Reading("object_z", (-10.0, 10.0), "m", "the same along world z, up", "worlds[i].com[1]"),
    Reading("object_angle", (-10.0, 10.0), "rad", "the object's angle about the grip axis",
            "worlds[i].angle"),
    Reading("object_mass", (0.0, 100.0), "kg", "the object's mass", "worlds[i].mass"),
    Reading("grip_force_1", grip_force, "N", "actuator force of finger 1", "fingers[i, 0].force"),
    Reading("grip_force_2", grip_force, "N", "actuator force of finger 2", "fingers[i, 1].force"),
    _grip("least_grip", "least grip that holds the object through the episode"),
    _grip("least_grip_now", "least grip under the present load"),
    _grip("grip_limit", "force at which the object breaks, or mean grip allowed"),
    Reading("grip_spent", (0.0, 10.0), "-",
            "sum of the grip so far over that allowed for the episode, 0: any is",
            "episodes[i].grip_sum / max(episodes[i].grip_budget, 1e-9)"),
    Reading("largest_slip", (0.0, 1.0), "m", "largest slip at the pad centre so far, 0 if it does not count",
            "episodes[i].largest_slip"),
    Reading("jump_time", (0.0, 1e4), "s", "time at which the friction jumps, 0: never or at once",
            "episodes[i].jump_step * episodes[i].step_time"),
    Reading("jump_factor", (0.0, 100.0), "-", "friction after that over before", "episodes[i].jump_factor"),
    Reading("mass_time", (0.0, 1e4), "s", "time at which the mass changes, 0: never or at once",
            "episodes[i].mass_step * episodes[i].step_time"),
    Reading("mass_factor", (0.0, 100.0), "-", "mass after that over before", "episodes[i].mass_factor"),
    Reading("friction_drift", (-10.0, 10.0), "1/s", "relative rate of the friction", "episodes[i].drift"),
    _drawn("stribeck_velocity", 1.0, "m/s", "Stribeck velocity"),
    _drawn("sigma_0", 1e9, "1/m", "stiffness of the bristles per normal force"),
    _drawn("load_exponent", 1.0, "-", "friction falls with the normal force to the power of this"),
    _drawn("radius_exponent", 1.0, "-", "contact radius grows with the normal force to the power of this"),
    _drawn("cop_lever", 0.1, "m", "shift of the centre of pressure over tangential by normal force"),
    _drawn("shear_compliance", 1.0, "m/N", "tangential compliance of a pad", "compliance"),
    _drawn("creep", 1.0, "-", "fraction of its stiffness that relaxes"),
    _drawn("aging", 1.0, "-", "growth of mu_s - mu_c with the logarithm of the dwell time"),
    _drawn("friction_axis_x", 2.0, "-", "friction along the pads' x axis over its mean", "axes[0]"),
    Reading("dead_time", (0.0, 10.0), "s", "dead time of the force loops",
            "fingers[i, 0].dead_ticks * worlds[i].tick_length"),
    Reading("slip_noise", (0.0, 1.0), "m", "noise of the slip sensors per axis and sample",
            "slip_sensors[i, 0].noise"),
    *_own(1),
    *_own(2),
)  # fmt: skip
"""The group's columns, in order: motion, the task's limits, disturbances, pads, actuators and sensors."""

_write_privileged_row = row_writer(
    "_write_privileged_row",
    [reading.read for reading in PRIVILEGED],
    ("state", "force_torque"),
    __file__,
    "Write `PRIVILEGED` of environment i.",
    before=of_state("worlds", "pads", "fingers", "episodes", "slip_sensors", "ground_truth"),
)


def privileged_columns(config: Config) -> tuple[Column, ...]:
    """Columns of the privileged group, in order."""
    return tuple(reading.column(config) for reading in PRIVILEGED)


@compiled
def write_privileged(rows, fixed, force_torque, low, high, out):
    """Write the privileged group of some rows (k,), clipped to its bounds (m,), to `out` (n, m), float32.

    `fixed` is a `Fixed` `BatchState`, `force_torque` FORCE_TORQUE (n, 2).
    """
    state = opened(fixed)
    for i in rows:
        _write_privileged_row(out[i], i, state, force_torque)
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])
