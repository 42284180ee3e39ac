"""Converts a trace into sensor records: as the gripper's sensors report it, or exact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import Config, Overrides, load
from slipgym.contact.records import pads
from slipgym.sensors.force_torque import sample_force_torque
from slipgym.sensors.measure import measure
from slipgym.sensors.slip_velocity import accumulate_slip
from slipgym.sensors.starting import draw_sensors, start_sensors
from slipgym.synthetic.integration import Trace
from slipgym.world.plant import build


@dataclass(frozen=True)
class Record:
    """m records of one course, at 120 Hz; they differ by the sensors' noise."""

    t: np.ndarray
    """Time, (n,) [s]."""
    wrenches: np.ndarray
    """Measured load (f_x, f_y, f_n, tau) on the finger at the CoP, (m, n, 4) [N, N, N, N m]."""
    twists: np.ndarray
    """Measured slip twist (v_x, v_y, omega) of the object there, (m, n, 3) [m/s, m/s, rad/s]."""
    mu_s: np.ndarray
    """True static friction, (n,) [-]."""
    mu_c: np.ndarray
    """True Coulomb friction, (n,) [-]."""
    r: np.ndarray
    """True radius of the equivalent rim contact, (n,) [m]."""
    phase: np.ndarray
    """Label of the course's phase, (n,)."""


def ideal(trace: Trace, instant: bool = False) -> Record:
    """The trace itself: no noise, no latency, no counts; one record.

    Args:
        trace: The trace.
        instant: Whether a twist is that of the sampling instant, as the force is; otherwise it is
            the mean since the last one.
    """
    twists = trace.twist if instant else trace.motion / np.diff(trace.t, prepend=0.0)[:, None]
    wrenches = np.column_stack([-trace.wrench[:, :2], trace.normal, -trace.wrench[:, 2]])
    return _record(trace, wrenches[None], twists[None].copy())


def sense(
    trace: Trace, m: int = 1, seed: int = 0, sensors: str = "realistic", config: Overrides | None = None
) -> Record:
    """The trace as m fingers' sensors report it.

    These are the environment's own sensors, with one difference: a force is of the sampling
    instant, not up to 1 ms older, and has neither latency nor the finger's vibration.

    Args:
        trace: The trace.
        m: Records, each with its own noise and its own rests of counts.
        seed: Of the noise, >= 0.
        sensors: Preset of the sensors, "realistic", "ideal" or "lab".
        config: Overrides of the configuration, such as `{"sensors": {"slip": {"latency_samples": 2}}}`.

    Raises:
        ValueError: The preset or an override is not valid, or m is not positive.
    """
    if m < 1:
        raise ValueError(f"m = {m!r} must be at least 1")
    plant = build(_at_once(load(config, sensors)), -(-m // 2))  # both fingers have noise of their own
    rng = np.random.default_rng(seed)
    force_torque, slip_sensors = plant.force_torque, plant.slip_sensors
    start_sensors(force_torque.reshape(-1), slip_sensors.reshape(-1), *draw_sensors(slip_sensors.size, rng))
    fingers, n = slip_sensors.shape, len(trace.t)
    pad = pads(1)
    wrenches, twists = np.zeros((*fingers, 4)), np.zeros((*fingers, 3))
    every_wrench, every_twist = np.zeros((m, n, 4)), np.zeros((m, n, 3))
    for k in range(n):
        plant.world["tick"] += force_torque["period"][:, 0]
        pad["wrench"], pad["normal"] = trace.wrench[k], trace.normal[k]
        _expose(plant.world, force_torque, slip_sensors, pad, trace.motion[k])
        measure(plant.world, force_torque, slip_sensors, wrenches, twists)
        every_wrench[:, k] = wrenches.reshape(-1, 4)[:m]
        every_twist[:, k] = twists.reshape(-1, 3)[:m]
    return _record(trace, every_wrench, every_twist)


def _at_once(config: Config) -> Config:
    """The configuration with a force sensor that reads the load of the instant."""
    changed = {"latency": 0.0, "latency_spread": 0.0, "mode_frequency": None}
    force_torque = config.sensors.force_torque.model_copy(update=changed)
    sensors = config.sensors.model_copy(update={"force_torque": force_torque})
    return config.model_copy(update={"sensors": sensors})


@compiled
def _expose(
    worlds: np.ndarray,
    force_torque: np.ndarray,
    slip_sensors: np.ndarray,
    pad: np.ndarray,
    motion: np.ndarray,
) -> None:
    """Apply the pad's load and its slip since the last control step to all fingers' sensors."""
    for i in range(slip_sensors.shape[0]):
        for f in range(2):
            accumulate_slip(slip_sensors[i, f], motion)
            sample_force_torque(force_torque[i, f], pad[0], worlds[i].tick)


def _record(trace: Trace, wrenches: np.ndarray, twists: np.ndarray) -> Record:
    ground_truth = {name: getattr(trace, name) for name in ("mu_s", "mu_c", "r", "phase")}
    return Record(trace.t, wrenches, twists, **ground_truth)
