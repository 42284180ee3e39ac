"""Applies sampled initial conditions to many environments, in compiled code."""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.slip_velocity import AXES
from slipgym.sensors.starting import KEYS, start_sensors
from slipgym.world.placing import place_world

WARM_UP_STEPS = 6
"""Control steps before time 0 in which grip and sensors settle."""
START = np.dtype(
    [
        ("row", "i8"),  # which environment
        ("force", "f8"),  # grip force per finger [N]
        ("mass", "f8"),  # [kg]
        ("inertia", "f8"),  # about the centre of mass and the grip axis [kg m^2]
        ("half_thickness", "f8"),  # of the object along the grip axis [m]
        ("grasp_point", "f8", 2),  # pad centre (x, z) at the grasp from the centre of mass [m]
        ("reach", "f8", 2),  # as in EPISODE, like the next one
        ("object_centre", "f8", 2),
        ("friction", "f8", 3),  # mu_s, mu_c [-], r [m]
        ("finger_friction", "f8", 2),  # of either pad over mu_s and mu_c [-]
        ("finger_radius", "f8", 2),  # of either pad over r [-]
        ("drift", "f8"),  # relative rate of mu_s and mu_c [1/s]
        ("bias_scale", "f8"),  # spread of the biases beyond the configured one, over the noise [-]
        # drawn last
        ("biases", "f8", (2, 6)),  # standard normal
        ("keys", "u8", (KEYS, 2)),  # of the sensors' noise
        ("shares", "f8", (2, AXES)),  # see `slipgym.sensors.starting`, like the keys
    ]
)
"""Sampled initial conditions of an episode; its task and its disturbances write the others into EPISODE."""
NUMBERS = [name for name in START.names or () if name not in ("biases", "keys", "shares")]
"""Fields of START that are sampled before those of the sensors."""


@compiled
def begin_episode(episodes, blank, starts, k):
    """Fill in the fields of an episode that all tasks have in common.

    Args:
        episodes: EPISODE (n,).
        blank: Initial values of every episode, EPISODE (1,).
        starts: START (m,).
        k: Index in `starts`.
    """
    start = starts[k]
    episodes[start.row] = blank[0]
    episode = episodes[start.row]
    episode.mass, episode.inertia = start.mass, start.inertia
    episode.mu_s, episode.mu_c, episode.drift = start.friction[0], start.friction[1], start.drift
    for a in range(2):
        episode.reach[a], episode.object_centre[a] = start.reach[a], start.object_centre[a]
        episode.finger_friction[a] = start.finger_friction[a]


@compiled
def grip(starts, episodes, worlds, pads, cells, fingers):
    """Bring worlds to rest, with the object in the grip.

    Args:
        starts: START (m,).
        episodes: EPISODE (n,), for the wrist.
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        cells: Patches (n, 2, CELL_FIELDS, m); None for ellipsoids.
        fingers: FINGER (n, 2).
    """
    for k in range(starts.shape[0]):
        start = starts[k]
        i = start.row
        wrist = episodes[i].wrist_start
        grasp = start.grasp_point
        body = start.mass, start.inertia, start.half_thickness, grasp[0], grasp[1]
        place_world(worlds, pads, cells, fingers, i, body, start.force, (wrist[0], wrist[1], wrist[2]))


@compiled
def equip(starts, spread, noise, pads, force_torque, slip_sensors, ground_truth):
    """Set the friction of the pads and reset the sensors.

    Args:
        starts: START (m,).
        spread: Standard deviation of the force/torque sensors' biases, (6,) [N, N m].
        noise: Noise of these sensors, which a sampled bias scale multiplies, (6,) [N, N m].
        pads: PAD (n, 2).
        force_torque: FORCE_TORQUE (n, 2).
        slip_sensors: SLIP_SENSOR (n, 2).
        ground_truth: Output (n, 6), of which the first three are mu_s, mu_c, r, mean of both pads.
    """
    for k in range(starts.shape[0]):
        start = starts[k]
        i = start.row
        for f in range(2):
            pad, factor = pads[i, f], start.finger_friction[f]
            pad.mu_s, pad.mu_c = factor * start.friction[0], factor * start.friction[1]
            pad.r = start.finger_radius[f] * start.friction[2]
            for a in range(6):
                scale = spread[a] + start.bias_scale * noise[a]
                force_torque[i, f].bias[a] = scale * start.biases[f, a]
        first, second = pads[i, 0], pads[i, 1]
        ground_truth[i, 0] = 0.5 * (first.mu_s + second.mu_s)
        ground_truth[i, 1] = 0.5 * (first.mu_c + second.mu_c)
        ground_truth[i, 2] = 0.5 * (first.r + second.r)
        start_sensors(force_torque[i], slip_sensors[i], start.keys, start.shares)


@compiled
def open_episodes(
    starts, fresh_states, fresh_estimates, slip_sensors, states, estimates, episodes, commands, terms
):
    """Reset measured slip, estimators, commands and reward terms, after grip and sensors have settled.

    Args:
        starts: START (m,).
        fresh_states: Of both fingers' estimators, (2,).
        fresh_estimates: ESTIMATE (2,).
        slip_sensors: SLIP_SENSOR (n, 2).
        states: Of the estimators, (2 n,).
        estimates: ESTIMATE (2 n,).
        episodes: EPISODE (n,).
        commands: (n, 4).
        terms: (n, k).
    """
    for k in range(starts.shape[0]):
        i = starts[k].row
        for f in range(2):
            slip_sensors[i, f].measured_slip[:] = 0.0
            states[2 * i + f], estimates[2 * i + f] = fresh_states[f], fresh_estimates[f]
        commands[i, :] = 0.0
        terms[i, :] = 0.0
        episodes[i].command = episodes[i].last_command = starts[k].force
