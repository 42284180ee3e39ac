"""Computes the privileged group of an observation: true friction, slip, contact forces, pose and mass."""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.envs.observation import FRICTION, FRICTION_COLUMNS
from slipgym.envs.readings import Reading, row_writer
from slipgym.tasks.task import Column


def _force(config: Config) -> tuple[float, float]:
    return 0.0, config.gripper.force_limit


def _friction(config: Config) -> tuple[float, float]:
    """Bound of one pad's friction, at the largest friction coefficient [N]."""
    limit = FRICTION_COLUMNS[0].high * config.gripper.force_limit
    return -limit, limit


def _torque(config: Config) -> tuple[float, float]:
    limit = _friction(config)[1] * config.gripper.pad_radius
    return -limit, limit


def _true(k: int) -> Reading:
    """Row k of the friction part, from the ground truth in place of the estimates."""
    return FRICTION[k]._replace(read=f"friction[i, {k}]")


def _pad(f: int) -> tuple[Reading, ...]:
    wrench = f"pads[i, {f - 1}].wrench"
    return (
        Reading(
            f"friction_x_{f}", _friction, "N", f"friction of pad {f} on the object, pad frame", f"{wrench}[0]"
        ),
        Reading(f"friction_y_{f}", _friction, "N", "the same along the pad's y axis", f"{wrench}[1]"),
        Reading(f"friction_tau_{f}", _torque, "N m", f"friction torque at pad {f}'s CoP", f"{wrench}[2]"),
    )


PRIVILEGED = (
    *(_true(k) for k in range(3)),
    Reading("slip_x", (-1.0, 1.0), "m", "slip displacement since the grasp, pad frame", "worlds[i].slip[0]"),
    Reading("slip_y", (-1.0, 1.0), "m", "the same along the pad's y axis", "worlds[i].slip[1]"),
    Reading("slip_theta", (-10.0, 10.0), "rad", "the same about the grip axis", "worlds[i].slip[2]"),
    Reading(
        "slip_velocity_x", (-10.0, 10.0), "m/s", "slip velocity at the pad centre", "worlds[i].slip_twist[0]"
    ),
    Reading(
        "slip_velocity_y", (-10.0, 10.0), "m/s", "the same along the pad's y axis", "worlds[i].slip_twist[1]"
    ),
    Reading("slip_rate", (-100.0, 100.0), "rad/s", "the same about the grip axis", "worlds[i].slip_twist[2]"),
    *_pad(1),
    *_pad(2),
    Reading("object_x", (-10.0, 10.0), "m", "the object's centre of mass along world x", "worlds[i].com[0]"),
    Reading("object_z", (-10.0, 10.0), "m", "the same along world z, up", "worlds[i].com[1]"),
    Reading(
        "object_angle", (-10.0, 10.0), "rad", "the object's angle about the grip axis", "worlds[i].angle"
    ),
    Reading("object_mass", (0.0, 100.0), "kg", "the object's mass", "worlds[i].mass"),
    Reading("grip_force_1", _force, "N", "actuator force of finger 1", "fingers[i, 0].force"),
    Reading("grip_force_2", _force, "N", "actuator force of finger 2", "fingers[i, 1].force"),
)
"""The group's columns, in order."""

_write_row = row_writer(
    "_write_row",
    [reading.read for reading in PRIVILEGED],
    ("worlds", "pads", "fingers", "friction"),
    __file__,
    "Write `PRIVILEGED` of environment i.",
)


def columns(config: Config) -> tuple[Column, ...]:
    """Columns of the privileged group, in order."""
    return tuple(reading.column(config) for reading in PRIVILEGED)


@compiled
def write_privileged(worlds, pads, fingers, friction, low, high, out):
    """Write the privileged group, clipped to its bounds.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        friction: The ground truth (n, 11), of which the first three (mu_s, mu_c, r) are used.
        low: Lower bounds (m,).
        high: Upper bounds (m,).
        out: Output (n, m), float32.
    """
    for i in range(out.shape[0]):
        _write_row(out[i], i, worlds, pads, fingers, friction)
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])
