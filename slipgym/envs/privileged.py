"""What only a simulation knows: friction, slip, contact, pose and mass as they are."""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.envs.observation import FRICTION_COLUMNS
from slipgym.tasks.task import Column


def columns(config: Config) -> tuple[Column, ...]:
    """Columns of the privileged group, in order."""
    force = config.gripper.force_limit
    friction = FRICTION_COLUMNS[0].high * force  # of one pad
    torque = friction * config.gripper.pad_radius
    pads = []
    for f in (1, 2):
        pads += [
            Column(
                f"friction_x_{f}", -friction, friction, "N", f"friction of pad {f} on the object, pad frame"
            ),
            Column(f"friction_y_{f}", -friction, friction, "N", "the same along the pads' y axis"),
            Column(f"friction_tau_{f}", -torque, torque, "N m", f"its torque at pad {f}'s CoP"),
        ]
    return (
        *FRICTION_COLUMNS[:3],
        Column("slip_x", -1.0, 1.0, "m", "slip displacement since the grasp, pad frame"),
        Column("slip_y", -1.0, 1.0, "m", "the same along the pads' y axis"),
        Column("slip_theta", -10.0, 10.0, "rad", "the same about the grip axis"),
        Column("slip_velocity_x", -10.0, 10.0, "m/s", "slip velocity at the pad centre"),
        Column("slip_velocity_y", -10.0, 10.0, "m/s", "the same along the pads' y axis"),
        Column("slip_rate", -100.0, 100.0, "rad/s", "the same about the grip axis"),
        *pads,
        Column("object_x", -10.0, 10.0, "m", "the object's centre of mass along world x"),
        Column("object_z", -10.0, 10.0, "m", "the same along world z, up"),
        Column("object_angle", -10.0, 10.0, "rad", "the object's angle about the grip axis"),
        Column("object_mass", 0.0, 100.0, "kg", "the object's mass"),
        Column("grip_force_1", 0.0, force, "N", "actuator force of finger 1"),
        Column("grip_force_2", 0.0, force, "N", "actuator force of finger 2"),
    )


@compiled
def reveal(worlds, pads, fingers, friction, low, high, out):
    """Write the privileged group, clipped to its bounds.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        friction: True mu_s, mu_c, r, (n, 3).
        low: Lower bounds (m,).
        high: Upper bounds (m,).
        out: Output (n, m), float32.
    """
    for i in range(out.shape[0]):
        world = worlds[i]
        for k in range(3):
            out[i, k] = friction[i, k]
            out[i, 3 + k] = world.slip[k]
            out[i, 6 + k] = world.slip_twist[k]
            out[i, 9 + k] = pads[i, 0].wrench[k]
            out[i, 12 + k] = pads[i, 1].wrench[k]
        out[i, 15], out[i, 16], out[i, 17] = world.com[0], world.com[1], world.angle
        out[i, 18] = world.mass
        out[i, 19], out[i, 20] = fingers[i, 0].force, fingers[i, 1].force
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])
