"""Declares the sensor part of an observation: of sensors in the fingers, and of grippers as labs own them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.envs.readings import Limits, Reading, choice_reader
from slipgym.sensors.markers import COUNT


def either_way(limit: Callable[[Config], float]) -> Limits:
    """Limits of a number of either sign, from its largest size."""
    return lambda config: (-limit(config), limit(config))


_FORCE = either_way(lambda config: config.sensors.force_torque.force_range)
_NORMAL = either_way(lambda config: config.sensors.force_torque.normal_range)
_TORQUE = either_way(lambda config: config.sensors.force_torque.torque_range)
_VELOCITY = either_way(lambda config: 2 * config.sensors.slip.speed_max)
_RATE = either_way(lambda config: 2.0 * config.sensors.slip.speed_max / config.sensors.slip.chip_radius)


def grip_force(config: Config) -> tuple[float, float]:
    """Limits of a grip force."""
    return 0.0, config.gripper.force_limit


def _finger(f: int) -> tuple[Reading, ...]:
    """Measurements of finger 1 or 2."""
    wrench, twist = f"wrenches[i, {f - 1}, ", f"twists[i, {f - 1}, "
    about = f"slip rate about the grip axis at finger {f}"
    return (
        Reading(f"f_x_{f}", _FORCE, "N", f"tangential force on finger {f}", f"{wrench}0]"),
        Reading(f"f_y_{f}", _FORCE, "N", f"tangential force on finger {f}", f"{wrench}1]"),
        Reading(f"f_n_{f}", _NORMAL, "N", f"normal force of finger {f}", f"{wrench}2]"),
        Reading(f"tau_{f}", _TORQUE, "N m", f"torque at finger {f}'s CoP", f"{wrench}3]"),
        Reading(f"v_x_{f}", _VELOCITY, "m/s", f"slip velocity at finger {f}'s CoP", f"{twist}0]"),
        Reading(f"v_y_{f}", _VELOCITY, "m/s", f"slip velocity at finger {f}'s CoP", f"{twist}1]"),
        Reading(f"omega_{f}", _RATE, "rad/s", about, f"{twist}2]"),
    )


def _mean_slip(axis: int) -> str:
    return " + ".join(f"slip_sensors[i, {f}].measured_slip[{axis}]" for f in (0, 1)).join(("0.5 * (", ")"))


SENSORS = (
    *_finger(1),
    *_finger(2),
    Reading("measured_slip_x", (-1.0, 1.0), "m",
            "slip displacement, summed from the counts of both fingers", _mean_slip(0)),
    Reading("measured_slip_y", (-1.0, 1.0), "m", "the same along the pad's y axis", _mean_slip(1)),
    Reading("measured_slip_theta", (-10.0, 10.0), "rad", "the same about the grip axis", _mean_slip(2)),
    Reading("commanded_force", grip_force, "N", "grip force commanded in the last step",
            "episodes[i].command"),
)  # fmt: skip
"""Sensor part: wrench and twist of both fingers, measured slip, commanded force."""

_BY_NAME = {reading.name: reading for reading in SENSORS}


def _wrist(axis: str, of: str, meaning: str) -> Reading:
    """A sum over both fingers, as the wrist sees it; a reading holds half of it for each finger."""
    k = ("f_x", "f_y", "f_n", "tau").index(axis)
    own = _BY_NAME[f"{of}_1"]
    return Reading(f"wrist_{axis}", own.limits, own.unit, meaning, f"2.0 * wrenches[i, 0, {k}]")


WRIST_FORCES = (
    _wrist("f_x", "f_x", "force of the object on both fingers along the pad's x axis, at the wrist"),
    _wrist("f_y", "f_y", "the same along the pad's y axis"),
    _wrist("tau", "tau", "torque about the grip axis through the pad centre, at the wrist"),
)
MOTOR = (
    Reading("motor_force", _NORMAL, "N", "normal force per finger from the motor's load",
            "wrenches[i, 0, 2]"),
    Reading("opening", (-1.0, 10.0), "m", "distance of the pads from each other", "grippers[i].opening"),
    _BY_NAME["commanded_force"],
)  # fmt: skip


def _field(f: int) -> tuple[Reading, ...]:
    """Displacements of the markers of finger 1 or 2; `read_owned` finds them by their number."""
    return tuple(
        Reading(
            f"marker_{axis}_{k}_{f}", (-0.1, 0.1), "m",
            f"displacement of marker {k} of finger {f} along the pad's {axis} axis",
            "",
        )
        for k in range(COUNT)
        for axis in "xy"
    )  # fmt: skip


_FIELDS = *_field(1), *_field(2)
LAYOUTS = {
    "fingers": SENSORS,
    "wrist": (*WRIST_FORCES, *MOTOR),
    "motor": MOTOR,
    "markers": (*SENSORS, *_FIELDS),
}
"""Name -> sensor part; "markers" with the whole field."""
_SINGLE = tuple(dict.fromkeys((*SENSORS, *WRIST_FORCES, *MOTOR)))
OWNED = *_SINGLE, *_FIELDS
"""All readings of all sensor parts, each once."""
LOADED = ("fingers", "markers")
"""Layouts of which the load part is a part: the others do not measure each finger's force."""

_read_single = choice_reader(
    "_read_single",
    [reading.read for reading in _SINGLE],
    ("wrenches", "twists", "slip_sensors", "episodes", "grippers"),
    __file__,
    "Row k of the readings before the markers.",
)
_MARKERS = len(_SINGLE)


@compiled
def read_owned(k, i, wrenches, twists, slip_sensors, episodes, grippers, markers):
    """Row k of `OWNED` of environment i."""
    m = k - _MARKERS
    if m < 0:
        return _read_single(k, i, wrenches, twists, slip_sensors, episodes, grippers)
    return markers[i, m // (2 * COUNT)].seen[m // 2 % COUNT, m % 2]


def layout_of(config: Config) -> str:
    """Name of the sensor part in LAYOUTS."""
    sensors = config.sensors
    if sensors.markers is not None and sensors.markers.observed:
        return "markers"
    return sensors.place


def sensor_readings(config: Config) -> tuple[Reading, ...]:
    """The sensor part of a configuration."""
    return LAYOUTS[layout_of(config)]


def sensor_rows(config: Config) -> np.ndarray:
    """Rows of OWNED in the sensor part; none where it is `SENSORS`, which has a program of its own."""
    readings = sensor_readings(config)
    rows = [] if readings is SENSORS else [OWNED.index(reading) for reading in readings]
    return np.array(rows, dtype=np.int64)
