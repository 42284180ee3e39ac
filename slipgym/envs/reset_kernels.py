"""Applies sampled initial conditions to many environments, in compiled code.

`starts` are START (m,), `values` VALUES (m,) of the episodes that begin; `state` is a `BatchState` of n
environments, `episodes` EPISODE (n,), `worlds` WORLD (n,), `pads` PAD (n, 2), `fingers` FINGER (n, 2),
`force_torque` FORCE_TORQUE (n, 2), `cells` patches (n, 2, CELL_FIELDS, q), None for ellipsoids.
"""

from __future__ import annotations

import numpy as np

from estimator.sample import copy
from slipgym._numba.compiled import compiled, pointed
from slipgym._numba.generate import generate
from slipgym.config.pad import EFFECTS
from slipgym.contact.pressure import friction_axes, stretch
from slipgym.contact.records import CONFIGURED
from slipgym.envs.control_step import learn
from slipgym.sensors.markers import start_markers
from slipgym.sensors.owned import join_open, start_gripper
from slipgym.sensors.slip_velocity import AXES
from slipgym.sensors.starting import KEYS, start_sensors
from slipgym.sensors.unloaded import READINGS, read_unloaded
from slipgym.tasks.disturbance import bear
from slipgym.world.placing import PATCHES_OF_WORLDS, place_world
from slipgym.world.substep import weigh_tip

WARM_UP_STEPS = 6
"""Control steps before time 0 in which grip and sensors settle."""
CLOSING_STEPS = 60
"""Control steps between the last reading of the open gripper and time 0."""
START = np.dtype(
    [
        ("row", "i8"),  # which environment
        ("force", "f8"),  # grip force per finger [N]
        ("material", "i8"),  # place in the sorted names
        ("pressure", "i8"),  # place of the pressure profile among those of the randomization
        ("friction", "f8", 3),  # mu_s, mu_c [-], r [m]
        ("mass", "f8"),  # [kg]
        ("inertia", "f8"),  # about the centre of mass and the grip axis [kg m^2]
        ("size", "f8", 3),  # as in `slipgym.world.scene.Box`, like the next two
        ("com_offset", "f8", 2),
        ("grasp_offset", "f8", 2),
        # drawn last
        ("biases", "f8", (2, 6)),  # standard normal
        ("keys", "u8", (KEYS, 2)),  # of the sensors' noise
        ("shares", "f8", (2, AXES)),  # see `slipgym.sensors.starting`, like the keys
    ]
)
"""Sampled initial conditions of an episode; its task and its disturbances write the others into EPISODE."""
HARDWARE = np.dtype(
    [
        ("spread", "f8", 6),  # standard deviation of the force/torque sensors' biases [N, N m]
        ("noise", "f8", 6),  # of these sensors, which a sampled bias scale multiplies, too [N, N m]
        ("slip_noise", "f8"),  # of the slip sensors [m]
        ("clock", "f8"),  # ticks per second
        ("randomized", "?"),  # whether pads, force loop and sensors are sampled
    ]
)
"""What sampled parameters of the hardware refer to."""


@compiled
def grip(starts, episodes, worlds, pads, cells, fingers):
    """Bring worlds to rest, with the object in the grip; the wrist is that of the episodes."""
    for k in range(starts.shape[0]):
        start = starts[k]
        i = start.row
        wrist, grasp, com = episodes[i].wrist_start, start.grasp_offset, start.com_offset
        body = start.mass, start.inertia, start.size[1] / 2, grasp[0] - com[0], grasp[1] - com[1]
        place_world(worlds, pads, cells, fingers, i, body, start.force, (wrist[0], wrist[1], wrist[2]))
        bear(episodes[i], worlds[i])


randomize_pad = generate(
    "randomize_pad",
    ("pad", "value"),
    [
        "pad.stribeck_velocity, pad.sigma_0 = value.stribeck_velocity, value.sigma_0",
        "pad.speed_slope = value.speed_slope",
        *(f"pad.{CONFIGURED.get(name, name)} = value.{name}" for name in EFFECTS if name != "anisotropy"),
        "pad.axes[0], pad.axes[1] = friction_axes(value.anisotropy)",
    ],
    {"friction_axes": friction_axes},
    compiled,
    __file__,
    "Set the sampled parameters of a PAD record, from VALUES, but its friction and radius.",
)


@compiled
def set_patches(starts, patches, pads, cells):
    """Give pads the patch of their pressure profile, stretched by their axes; see `equip_rows`."""
    if cells is None:
        return
    if cells.ndim == PATCHES_OF_WORLDS:
        for k in range(starts.shape[0]):
            for f in range(2):
                patch = cells[starts[k].row, f]
                for field in range(patch.shape[0]):
                    copy(patches[starts[k].pressure, field], patch[field])
                stretch(patch, pads[starts[k].row, f].axes)


@compiled
def note_pads(episode, pads):
    """Write the parameters of pads, PAD (2,), that the least grip depends on into an EPISODE record."""
    first = pads[0]
    episode.reference_force, episode.radius_max = first.reference_force, first.radius_max
    episode.load_exponent, episode.radius_exponent = first.load_exponent, first.radius_exponent
    episode.compliance, episode.shear_time = first.compliance, first.shear_time
    for f in range(2):
        episode.axes[f], episode.radii[f] = first.axes[f], pads[f].r
        for a in range(2):
            episode.cops[f, a] = pads[f].cop[a]


@pointed
def equip_rows(starts, values, hardware, patches, state, cells, force_torque):
    """Set the parameters of pads, force loops and sensors; reset the sensors. `grip` comes later.

    `hardware` is HARDWARE (1,), `patches` has the patch of each pressure profile, (p, CELL_FIELDS, q). Of
    `ground_truth` mu_s, mu_c, r are set, mean of both pads.
    """
    own, pads, fingers, slip_sensors = hardware[0], state.pads, state.fingers, state.slip_sensors
    for k in range(starts.shape[0]):
        start, value = starts[k], values[k]
        i = start.row
        for f in range(2):
            pad, factor = pads[i, f], value.finger_friction[f]
            pad.mu_s, pad.mu_c = factor * start.friction[0], factor * start.friction[1]
            pad.r = value.finger_radius[f] * start.friction[2]
            pad.cop[0], pad.cop[1] = value.cop_offset[2 * f], value.cop_offset[2 * f + 1]
            fingers[i, f].lag, fingers[i, f].gain = value.finger_lag[f] * value.lag, value.force_gain[f]
            if own.randomized:
                randomize_pad(pad, value)
                fingers[i, f].stiction = value.stiction
                fingers[i, f].dead_ticks = np.int64(np.rint(value.dead_time * own.clock))
                slip_sensors[i, f].noise = value.noise_scale * own.slip_noise
                slip_sensors[i, f].least_delay = np.int64(value.slip_latency)
            for a in range(6):
                scale = own.spread[a] + value.bias_scale * own.noise[a]
                force_torque[i, f].bias[a] = scale * start.biases[f, a]
                if own.randomized:
                    force_torque[i, f].noise[a] = value.noise_scale * own.noise[a]
        present = state.episodes[i].present_friction
        for f in range(2):
            present[f, 0], present[f, 1], present[f, 2] = pads[i, f].mu_s, pads[i, f].mu_c, pads[i, f].r
        for k in range(3):
            state.ground_truth[i, k] = 0.5 * (present[0, k] + present[1, k])
        note_pads(state.episodes[i], pads[i])
        start_sensors(force_torque[i], slip_sensors[i], start.keys, start.shares)
        start_gripper(state.grippers[i], start.keys[1, 1])
        for f in range(2 if state.markers.shape[0] > 0 else 0):
            start_markers(state.markers[i, f], start.keys[0, f])
    if own.randomized:
        set_patches(starts, patches, pads, cells)


@compiled
def show_open_gripper(update, state, force_torque, i):
    """Update the estimators of environment i with the readings of its sensors before the grasp.

    The gripper is open: no slip sensor has a surface to see.
    """
    readings, twists = np.empty((2, READINGS, 4)), np.zeros((2, 3))
    wrenches = np.empty((2, 4))
    for f in range(2):
        weigh_tip(force_torque[i, f], state.worlds[i])
        read_unloaded(force_torque[i, f], readings[f])
    for k in range(READINGS):
        for f in range(2):
            for a in range(4):
                wrenches[f, a] = readings[f, k, a]
        join_open(state.grippers[i], k, wrenches)
        time = (k + 1 - READINGS - CLOSING_STEPS) * state.episodes[i].step_time
        learn(update, state, i, time, wrenches, twists)


@pointed
def open_episodes(update, starts, fresh, state, force_torque, terms):
    """Reset measured slip, estimators, commands and reward terms, after grip and sensors have settled.

    The estimators then see the sensors without load, as they were before the grasp. `fresh` holds, of both
    fingers, the initial states of the estimators as bytes (2, q) and ESTIMATE (2,), and whether there are
    estimators.
    """
    states, estimates, estimating = fresh
    for k in range(starts.shape[0]):
        i = starts[k].row
        for f in range(2):
            for a in range(3):
                state.slip_sensors[i, f].measured_slip[a] = 0.0
            for b in range(states.shape[1]):
                state.estimator_states[2 * i + f, b] = states[f, b]
            state.estimates[2 * i + f] = estimates[f]
        if estimating:
            show_open_gripper(update, state, force_torque, i)
        for a in range(state.commands.shape[1]):
            state.commands[i, a] = 0.0
        for a in range(terms.shape[1]):
            terms[i, a] = 0.0
        state.episodes[i].command = state.episodes[i].last_command = starts[k].force
