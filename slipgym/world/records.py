"""Plain-array state of the planar world: body, wrist, fingers and clock."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from slipgym.contact.fields import comparison, joined, transfer

QUEUE = 32  # force commands that can be under way in the dead time

WORLD = np.dtype(
    [
        ("tick", "i8"),  # time in ticks since reset
        ("tick_length", "f8"),  # [s]
        ("control_ticks", "i8"),  # ticks per control step
        ("engine_ticks", "i8"),  # ticks per engine step
        ("substep_ticks", "i8"),  # longest friction sub-step in ticks
        ("calm_ticks", "i8"),  # the same without an engine, near the friction limit
        ("gravity", "f8"),  # [m/s^2], along -z
        ("mass", "f8"),  # [kg]
        ("inertia", "f8"),  # about the centre of mass and the grip axis [kg m^2]
        ("half_thickness", "f8"),  # of the object along the grip axis [m]
        ("com", "f8", 2),  # centre of mass in the world plane (x, z) [m]
        ("angle", "f8"),  # of the object about the grip axis [rad]
        ("velocity", "f8", 3),  # of the centre of mass, world [m/s, m/s, rad/s]
        ("external", "f8", 3),  # disturbance on the centre of mass, world [N, N, N m]
        ("wrist", "f8", 3),  # pad centre (x, z) and pitch as the engine has it [m, m, rad]
        ("wrist_plan", "f8", 3),  # the same as commanded [m, m, rad]
        ("wrist_velocity", "f8", 3),  # commanded, now [m/s, m/s, rad/s]
        ("wrist_acceleration", "f8", 3),  # commanded, over this control step [m/s^2, m/s^2, rad/s^2]
        ("pitch", "f8"),  # wrist pitch that `axes` belong to [rad]
        ("axes", "f8", 2),  # its cosine and sine [-]
        ("relative", "f8", 3),  # centre of mass and angle in the pad frame [m, m, rad]
        ("relative_velocity", "f8", 3),  # of the centre of mass, mean of a short sub-step [m/s, m/s, rad/s]
        ("grasp_point", "f8", 2),  # body point at the pad centre at the grasp, from the com [m]
        ("slip", "f8", 3),  # slip displacement (x, y, theta) [m, m, rad]
        ("slip_twist", "f8", 3),  # at the pad centre [m/s, m/s, rad/s]
    ]
)
"""One object held by one gripper, seen from finger 2: the grip axis points at the viewer."""

FINGER_FIXED = np.dtype(
    [
        ("force_limit", "f8"),  # hard limit of the actuator [N]
        ("open_below", "f8"),  # commands below it open the force loop [N]
    ]
)
"""Parameters that the configuration fixes for all episodes."""
FINGER_EPISODE = np.dtype(
    [
        ("lag", "f8"),  # time constant of the force loop [s]
        ("dead_ticks", "i8"),  # dead time in ticks
        ("gain", "f8"),  # actuator force over the commanded [-]
        ("stiction", "f8"),  # change of the command, times gain, that friction swallows when it turns [N]
    ]
)
"""Parameters that an episode may have of its own."""
FINGER_PARAMETERS = joined(FINGER_FIXED, FINGER_EPISODE)
FINGER_STATE = np.dtype(
    [
        ("queued", "i8"),  # commands ever queued
        ("served", "i8"),  # commands ever put into effect
        ("settled", "f8"),  # force at which the command queued last settles [N]
        ("command", "f8"),  # command in effect, times gain and within stiction [N]
        ("force", "f8"),  # actuator force now [N]
        ("mean_force", "f8"),  # mean force of both actuators, mean over the engine step [N]
        ("contact_mean_force", "f8"),  # the same over the step of `contact_force` [N]
        ("contact_force", "f8"),  # normal force of the engine, mean over its last step [N]
        ("reaction", "f8", 3),  # friction on the object, world, mean over the engine step [N, N, N m]
    ]
)
FINGER_SCRATCH = np.dtype(
    [
        ("relaxed", "f8"),  # sub-step over lag that the next three belong to [-]
        ("decay", "f8"),  # of the gap to the command over a sub-step [-]
        ("mean_decay", "f8"),  # its mean over the sub-step [-]
        ("early_decay", "f8"),  # the same weighted by the time that is left [-]
    ]
)
FINGER_QUEUE = np.dtype(
    [
        ("queue_tick", "i8", QUEUE),  # when a command takes effect
        ("queue_force", "f8", QUEUE),  # its value, times gain [N]
    ]
)
"""Commands under way. Both fingers get the same ones: where parameters and `queued` agree, these do."""
FINGER = joined(FINGER_PARAMETERS, FINGER_STATE, FINGER_SCRATCH, FINGER_QUEUE)
"""One finger: force loop, normal contact and the friction impulse it passes on."""
same_fingers = comparison(
    "same_fingers",
    (FINGER_PARAMETERS, FINGER_STATE),
    __file__,
    "Whether two fingers that have had the same commands have the same force loop and force.",
)
copy_finger_state = transfer(
    "copy_finger_state",
    (FINGER_STATE,),
    __file__,
    "Copy the state of a finger to one of the same parameters.",
)

TILT = np.dtype(
    [
        ("stiffness", "f8"),  # of a pad's normal contact [N/m]
        ("relaxation", "f8"),  # its damping over its stiffness [s]
        ("pad_radius", "f8"),  # [m]
        ("jaw_mass", "f8"),  # of both fingers [kg]
        ("jaw_damping", "f8"),  # of both fingers [N s/m]
        ("gravity", "f8"),  # [m/s^2]
        ("gyration", "f8", 3),  # squared radii of gyration about the object's axes (x, grip axis, z) [m^2]
        ("roll", "f8", 3),  # wrist roll, its rate and acceleration [rad, rad/s, rad/s^2]
        ("sway", "f8", 3),  # wrist along +y: position, velocity, acceleration [m, m/s, m/s^2]
        ("height", "f8"),  # centre of mass along +y from the gripper's middle [m]
        ("speed", "f8"),  # its rate [m/s]
        ("attitude", "f8", 4),  # quaternion (x, y, z, w) of the object
        ("momentum", "f8", 3),  # angular momentum about the centre of mass [kg m^2/s]
        ("spin", "f8", 3),  # angular velocity [rad/s]
        ("closure", "f8"),  # of either jaw beyond first touch of an upright object [m]
        ("closing", "f8"),  # its rate [m/s]
        ("normal", "f8", 2),  # normal force of finger 1 and 2, mean over the engine step [N]
        ("moment", "f8", (2, 2)),  # of either pad's pressure about the pad's centre [N m], likewise
        ("cop_rest", "f8", (2, 2)),  # centre of either pad's pressure without tilt, pad frame [m]
        ("cop", "f8", (2, 2)),  # the same with tilt, as last written to PAD [m]
    ]
)
"""Motion of one object and its gripper out of the contact plane, in the frame that rolls with the wrist."""

World: TypeAlias = Any
"""A record of `WORLD`. Compiled code reads its fields as attributes, which numpy's types do not describe."""
Finger: TypeAlias = Any
"""A record of `FINGER`."""
Tilt: TypeAlias = Any
"""A record of `TILT`."""
Records: TypeAlias = Any
"""Records of the two fingers, pads or sensors, as an array or as a tuple."""
