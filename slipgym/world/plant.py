"""`Plant`, the arrays of n worlds, and its construction from a configuration."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from pydantic import BaseModel

from slipgym.config import Config
from slipgym.contact.pressure import OUTER_RADII, friction_axes, patch_cells, stretch
from slipgym.contact.records import CONFIGURED, DISC, ELLIPSOID, pads, patch, rest
from slipgym.sensors.force_torque import FEW, force_torque
from slipgym.sensors.force_torque import HISTORY as FORCE_HISTORY
from slipgym.sensors.markers import COLUMNS, MARKERS, ROWS
from slipgym.sensors.owned import GRIPPER, PLACES
from slipgym.sensors.slip_velocity import HISTORY as SLIP_HISTORY
from slipgym.sensors.slip_velocity import SLIP_SENSOR, chip_positions
from slipgym.sensors.structure import LOAD, mode
from slipgym.world.actuator import FINGER_DAMPING
from slipgym.world.records import FINGER, QUEUE, TILT, WORLD

MIRROR = (1.0, -1.0)  # finger 2 sees the grip axis from the other side


@dataclass
class Plant:
    """State and parameters of n worlds as structured arrays with a leading batch axis.

    Plain data: copying the arrays saves every bit of the planar state.
    """

    world: np.ndarray
    """WORLD (n,)."""
    pads: np.ndarray
    """PAD (n, 2)."""
    cells: np.ndarray | None
    """Patches (n, 2, CELL_FIELDS, m); None for hard ellipsoids, (n, 2, 0) for pads that are soft or discs."""
    fingers: np.ndarray
    """FINGER (n, 2)."""
    force_torque: np.ndarray
    """FORCE_TORQUE (n, 2)."""
    slip_sensors: np.ndarray
    """SLIP_SENSOR (n, 2)."""
    grippers: np.ndarray
    """GRIPPER (n,)."""
    markers: np.ndarray
    """MARKERS (n, 2); without markers (0, 2)."""
    tilt: np.ndarray | None = None
    """TILT (n,); None without `physics.tilt`."""

    def restore(self, other: Plant, rows: np.ndarray) -> None:
        """Copy rows (n,) bool of every array of another plant of the same size into this one."""
        for field in fields(self):
            array = getattr(self, field.name)
            if array is not None and len(array):
                array[rows] = getattr(other, field.name)[rows]


def build(config: Config, n: int = 1) -> Plant:
    """Return n worlds at rest with the configuration's default object and no friction yet."""
    tick_rate = ticks_per_second(config)
    return Plant(
        world=_world(config, n, tick_rate),
        pads=_pads(config, n),
        cells=_cells(config, n),
        fingers=_fingers(config, n),
        force_torque=_force_torque(config, n, tick_rate),
        slip_sensors=_slip_sensors(config, n),
        grippers=_grippers(config, n),
        markers=_markers(config, n),
        tilt=_tilt(config, n),
    )


def ticks_per_second(config: Config) -> int:
    """Rate of the clock that all others are whole fractions of [Hz]."""
    return math.lcm(config.physics.engine_rate, config.sensors.force_torque.rate)


def dead_ticks(config: Config, dead_time: float, name: str = "gripper.dead_time") -> int:
    """A dead time of the force loop in ticks.

    Raises:
        ValueError: More commands would be under way than the queue holds.
    """
    clock, rate = ticks_per_second(config), config.physics.control_rate
    ticks = round(dead_time * clock)
    if ticks * rate >= QUEUE * clock:
        raise ValueError(f"{name} = {dead_time:g} s must be below {QUEUE} control steps ({QUEUE / rate:g} s)")
    return ticks


def check_slip_latency(config: Config, samples: int, name: str = "latency_samples") -> None:
    """Raise ValueError if samples of this age are no longer in the slip sensor's history."""
    sensor = config.sensors.slip
    samples += sensor.latency_spread + (sensor.jitter > 0.0)
    if sensor.latency_spread or sensor.jitter > 0.0:
        name += " + latency_spread + jitter"
    if sensor.window + samples >= SLIP_HISTORY:
        raise ValueError(
            f"sensors.slip: window + {name} = {sensor.window + samples} must be below {SLIP_HISTORY}"
        )


def patch_of(config: Config) -> np.ndarray:
    """Cells of a pad's patch, (CELL_FIELDS, m), in units of their own r.

    In pure spin they then carry exactly the torque of r.
    """
    positions, loads = patch_cells(config.contact.pressure, config.contact.cells)
    return patch(positions / (loads @ np.hypot(*positions.T)), loads)


def _world(config: Config, n: int, tick_rate: int) -> np.ndarray:
    world = np.zeros(n, WORLD)
    world["tick_length"] = 1.0 / tick_rate
    world["control_ticks"] = tick_rate // config.physics.control_rate
    world["engine_ticks"] = tick_rate // config.physics.engine_rate
    physics = config.physics
    patches = config.contact.model == "distributed"
    longest = min(physics.substep_max, physics.patch_substep_max) if patches else physics.substep_max
    world["substep_ticks"] = max(1, math.floor(longest * tick_rate * (1 + 1e-9)))
    world["calm_ticks"] = max(1, math.floor(config.physics.planar_substep_max * tick_rate * (1 + 1e-9)))
    world["gravity"] = config.physics.gravity
    world["axes"] = 1.0, 0.0
    return world


def _pads(config: Config, n: int) -> np.ndarray:
    contact = config.contact
    fields = "stribeck_velocity", "stribeck_exponent", "speed_slope", "sigma_0", "sigma_1", "sigma_2"
    array = pads((n, 2), **{field: getattr(contact, field) for field in fields})
    array["r"] = config.contact_radius * np.array(contact.finger_radius)
    array["cop"] = contact.cop_offset
    array["surface"] = DISC if contact.model == "disc" else ELLIPSOID
    array["radius_max"] = config.gripper.pad_radius / OUTER_RADII[config.contact.pressure]
    for name, value in contact.pad.model_dump(exclude={"anisotropy"}).items():
        array[CONFIGURED.get(name, name)] = value
    array["axes"] = friction_axes(contact.pad.anisotropy)
    rest(array.reshape(-1))
    return array


def _cells(config: Config, n: int) -> np.ndarray | None:
    """The patch of every pad, which an episode scales by its r alone; an empty one for other contacts."""
    if config.contact.model == "distributed":
        cells = patch_of(config)
        stretch(cells, np.array(friction_axes(config.contact.pad.anisotropy)))
        return np.tile(cells, (n, 2, 1, 1))
    if config.contact.model == "ellipsoid" and config.contact.pad.hard:
        return None
    return without_cells(n)


def without_cells(n: int) -> np.ndarray:
    """`Plant.cells` of pads that are soft or discs: no numbers, only their kind."""
    return np.zeros((n, 2, 0))


def _fingers(config: Config, n: int) -> np.ndarray:
    gripper = config.gripper
    fingers = np.zeros((n, 2), FINGER)
    fingers["lag"] = gripper.lag * np.array(gripper.finger_lag)
    fingers["gain"], fingers["stiction"] = gripper.force_gain, gripper.stiction
    fingers["dead_ticks"] = dead_ticks(config, gripper.dead_time)
    fingers["force_limit"] = gripper.force_limit
    fingers["open_below"] = gripper.open_below
    return fingers


def _force_torque(config: Config, n: int, tick_rate: int) -> np.ndarray:
    sensor = config.sensors.force_torque
    longest = sensor.latency + sensor.latency_spread
    kept = round(longest * tick_rate) * sensor.rate // tick_rate + 2
    if kept > FORCE_HISTORY:
        name = "latency + latency_spread" if sensor.latency_spread else "latency"
        raise ValueError(
            f"sensors.force_torque.{name} = {longest:g} s must be below {FORCE_HISTORY - 1} samples "
            f"({(FORCE_HISTORY - 1) / sensor.rate:g} s)"
        )

    def six(tangential: float, normal: float, torque: float) -> tuple[float, ...]:
        return (tangential, tangential, normal, torque, torque, torque)

    misaligned = sensor.off_centre + sensor.tilt + sensor.crosstalk > 0.0
    large = misaligned or sensor.mode_frequency is not None or kept > FEW
    array = np.zeros((n, 2), force_torque(large))
    if sensor.mode_frequency is not None:
        array["mode"] = mode(sensor.mode_frequency, sensor.mode_damping, 1.0 / sensor.rate)
        array["swing"][..., LOAD, 0] = np.inf
    array["period"] = tick_rate // sensor.rate
    array["delay"] = array["least_delay"] = round(sensor.latency * tick_rate)
    array["delay_spread"] = round(sensor.latency_spread * tick_rate)
    array["own_delay"] = sensor.own_latency and config.sensors.place == "fingers"
    _take_over(sensor, array)
    array["least_tip"], array["tip_spread"] = sensor.tip_mass, sensor.tip_mass_spread
    array["misaligned"] = misaligned
    array["kept"] = kept
    array["mirror"] = MIRROR
    array["noise"] = six(sensor.noise_tangential, sensor.noise_normal, sensor.noise_torque)
    array["drift"] = six(sensor.drift_tangential, sensor.drift_normal, sensor.drift_torque)
    array["drift"] /= math.sqrt(config.physics.control_rate)
    array["resolution"] = six(sensor.resolution_force, sensor.resolution_force, sensor.resolution_torque)
    array["range"] = six(sensor.force_range, sensor.normal_range, sensor.torque_range)
    return array


def _slip_sensors(config: Config, n: int) -> np.ndarray:
    sensor = config.sensors.slip
    check_slip_latency(config, sensor.latency_samples)
    positions = chip_positions(sensor.chip_radius, sensor.chips)
    slip_sensors = np.zeros((n, 2), SLIP_SENSOR)
    _take_over(sensor, slip_sensors)
    slip_sensors["mirror"] = MIRROR
    slip_sensors["sample_time"] = 1.0 / sensor.rate
    slip_sensors["count"] = sensor.count if sensor.counts else 0.0
    slip_sensors["noise"] = sensor.noise * sensor.count
    slip_sensors["range"] = sensor.speed_max / sensor.rate
    slip_sensors["delay"] = slip_sensors["least_delay"] = sensor.latency_samples
    slip_sensors["own_delay"] = sensor.own_latency
    slip_sensors["rest_after"] = max(1, round(sensor.rest_after * sensor.rate))
    slip_sensors["rest_most"] = round(sensor.rest_period * sensor.rate)
    slip_sensors["delay_spread"], slip_sensors["scale_spread"] = sensor.latency_spread, sensor.scale_error
    slip_sensors["scale"], slip_sensors["failed"], slip_sensors["delivered"] = 1.0, -1, -1
    slip_sensors["at"] = positions
    slip_sensors["spread"] = np.sum(positions**2)
    return slip_sensors


def _grippers(config: Config, n: int) -> np.ndarray:
    sensors, grippers = config.sensors, np.zeros(n, GRIPPER)
    _take_over(sensors.motor, grippers)
    grippers["usual"], grippers["interval"] = sensors.usual, sensors.interval
    grippers["place"], grippers["gain"] = PLACES.index(sensors.place), 1.0
    grippers["softness"] = 2.0 / config.contact.normal_stiffness
    return grippers


def _markers(config: Config, n: int) -> np.ndarray:
    own = config.sensors.markers
    if own is None:
        return np.zeros((0, 2), MARKERS)
    markers = np.zeros((n, 2), MARKERS)
    _take_over(own, markers)
    markers["latency"] = own.latency_frames
    markers["spacing"] = 2.0 * config.gripper.pad_radius / np.array((COLUMNS, ROWS))
    markers["gain"] = markers["normal_gain"] = 1.0
    return markers


def _take_over(config: BaseModel, array: np.ndarray) -> None:
    """Write the values of a configuration into the fields of their names; others have units of their own."""
    for name, value in config:
        if name in (array.dtype.names or ()):
            array[name] = value


def _tilt(config: Config, n: int) -> np.ndarray | None:
    if not config.physics.tilt:
        return None
    tilt = np.zeros(n, TILT)
    tilt["stiffness"] = config.contact.normal_stiffness
    tilt["relaxation"] = config.contact.normal_damping / config.contact.normal_stiffness
    tilt["pad_radius"] = config.gripper.pad_radius
    tilt["jaw_mass"] = 2.0 * config.gripper.finger_mass
    tilt["jaw_damping"] = 2.0 * FINGER_DAMPING
    tilt["gravity"] = config.physics.gravity
    tilt["cop_rest"] = tilt["cop"] = config.contact.cop_offset
    return tilt
