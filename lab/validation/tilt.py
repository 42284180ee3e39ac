"""Checks the motion out of the contact plane: static balance, oscillation and free motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from lab.validation.tilt_oracle import free_attitude, slope_of_balance
from slipgym.validation.bench import Bench, Figure, Friction
from slipgym.world.wrist import ramp_tilt

BOUND, FREE_BOUND = 1.0, 0.1  # [%]
FORCE = 5.0  # grip per finger [N]
LEVERS = 0.004, 0.010, 0.014, 0.024, 0.034
"""Lever of the weight in a wrist rolled by 90 degrees [m]; a pad's edge lifts off at 15 mm."""
ROLLS = 0.2, -0.5, 1.2
"""[rad]"""
SPIN = np.array([3.0, -2.0, 4.0])  # of the thrown object [rad/s]
DURATION = 0.5  # [s]


def tilting(overrides: dict[str, Any] | None = None, **options: Any) -> Bench:
    """A bench whose object may tilt, with friction that holds it."""
    merged = {name: dict(group) for name, group in (overrides or {}).items()}
    merged["physics"] = {"tilt": True, **merged.get("physics", {})}
    return Bench(merged, friction=Friction(3.0, 3.0), **options)


def record(bench: Bench) -> np.void:
    """The TILT record of a bench."""
    assert bench.plant.tilt is not None
    return bench.plant.tilt[0]


def thrown(roll: float = 0.0, **options: Any) -> Bench:
    """A bench whose jaws are far open, around an object that nothing holds."""
    bench = tilting(force=0.0, roll=roll, **options)
    record(bench)["closure"] = -10.0
    return bench


def roll_over(bench: Bench, roll: float, duration: float = 0.6) -> None:
    """Roll the wrist to an angle [rad] at rest, and let the object settle."""
    steps = round(duration / bench.step_time)
    tilt = record(bench)
    for k in range(steps):
        share = (k + 1) / steps
        rate = roll / duration * (1.0 - math.cos(math.tau * share))
        ramp_tilt(tilt, rate, 0.0, math.inf, math.inf, bench.step_time)
        bench.run(bench.step_time)
    ramp_tilt(tilt, 0.0, 0.0, math.inf, math.inf, bench.step_time)
    bench.run(0.8)


def tilt_angle(bench: Bench) -> float:
    """Angle of the object out of the contact plane [rad]."""
    return float(np.linalg.norm(Rotation.from_quat(record(bench)["attitude"]).as_rotvec()[[0, 2]]))


def balance(lever: float) -> tuple[float, float, float]:
    """Tilt under the weight at a lever: measured, of linear springs, of the independent balance [rad]."""
    with tilting(force=FORCE, com_offset=(0.0, -lever)) as bench:
        roll_over(bench, 0.5 * math.pi)
        stiffness, radius = bench.config.contact.normal_stiffness, bench.config.gripper.pad_radius
        weight = bench.box.mass * bench.config.physics.gravity
        forces = FORCE - 0.5 * weight, FORCE + 0.5 * weight
        slope = slope_of_balance(forces, weight * lever, stiffness, radius)
        linear = weight * lever / (2.0 * stiffness * radius**2 / 4.0)
        return tilt_angle(bench), linear, math.atan(slope)


def static() -> Iterator[Figure]:
    """A weight across the grip axis, with and without a lever."""
    found = [balance(lever) for lever in LEVERS]
    lifted = [abs(linear / exact - 1.0) > 1e-6 for _, linear, exact in found]
    linear = max(abs(tilt / line - 1.0) for (tilt, line, _), up in zip(found, lifted, strict=True) if not up)
    beyond = max(abs(tilt / exact - 1.0) for (tilt, _, exact), up in zip(found, lifted, strict=True) if up)
    yield Figure("tilt under a moment, up to lift-off: against M / K", BOUND, 100.0 * linear, "%")
    yield Figure("tilt under a moment, beyond: against quadrature", BOUND, 100.0 * beyond, "%")
    worst = 0.0
    for roll in ROLLS:
        with tilting(force=FORCE, com_offset=(0.01, -0.01)) as bench:
            roll_over(bench, roll)
            half = 0.5 * bench.box.mass * bench.config.physics.gravity * math.sin(roll)
            normal = bench.plant.fingers["contact_force"][0]
            worst = max(worst, *np.abs(normal / (FORCE - half, FORCE + half) - 1.0))
    yield Figure("normal forces in a rolled grip: f -/+ m g sin(roll) / 2", BOUND, 100.0 * worst, "%")


def oscillation(axis: int) -> float:
    """Frequency of a small tilt oscillation about x (0) or z (2) over sqrt(2 K / I), less 1 [%]."""
    pads = {"normal_stiffness": 1e4, "normal_damping": 0.0}
    with tilting({"contact": pads, "physics": {"gravity": 0.0}}, force=FORCE) as bench:
        tilt = record(bench)
        inertia = bench.box.mass * float(tilt["gyration"][axis])
        expected = math.sqrt(2.0 * 1e4 * bench.config.gripper.pad_radius**2 / 4.0 / inertia)
        tilt["momentum"][axis] = 0.01 * expected * inertia
        angles = []
        for _ in range(120):
            bench.run(bench.step_time)
            angles.append(float(Rotation.from_quat(tilt["attitude"]).as_rotvec()[axis]))
        signal, dt = np.array(angles), bench.step_time
    # a sampled sine: the neighbours of a sample add up to 2 cos(omega dt) times it
    cosine = (signal[1:-1] @ (signal[2:] + signal[:-2])) / (2.0 * signal[1:-1] @ signal[1:-1])
    return 100.0 * abs(math.acos(cosine) / dt / expected - 1.0)


def falling(roll: float) -> float:
    """Fall of a free object in a rolled wrist against g t^2 / 2, along both axes, worst [%]."""
    with thrown(roll) as bench:
        start, times, path = bench.world.reading[0][0], [], []
        for _ in range(round(DURATION / bench.step_time)):
            bench.run(bench.step_time)
            times.append(bench.time)
            path.append(np.subtract(bench.world.reading[0][0], start))
        fallen = 0.5 * bench.config.physics.gravity * np.array(times) ** 2
    expected = -np.outer(fallen, (math.sin(roll), math.cos(roll)))
    return 100.0 * float(np.abs(np.array(path)[:, 1:] / expected - 1.0).max())


def tumbling() -> tuple[float, float]:
    """A thrown object: its attitude over the angle turned, and its angular momentum, against theory [%]."""
    with thrown() as bench:
        tilt = record(bench)
        principal = bench.box.mass * tilt["gyration"].copy()
        tilt["momentum"] = principal * SPIN
        attitudes = []
        for _ in range(round(DURATION / bench.step_time)):
            bench.run(bench.step_time)
            attitudes.append(bench.world.reading[0][1])
        found = Rotation.from_quat(np.array(attitudes))
        kept = np.linalg.norm(tilt["momentum"] - principal * SPIN) / np.linalg.norm(principal * SPIN)
        times = bench.step_time * np.arange(1, len(attitudes) + 1)
    away = (found * free_attitude(principal, SPIN, times).inv()).magnitude()
    turned = np.linalg.norm(SPIN) * times
    return 100.0 * float((away / turned).max()), 100.0 * float(kept)


def rolling_frame() -> float:
    """A thrown object seen from a wrist that rolls and sways, against its parabola in space [mm]."""
    worst, rate, sway = 0.0, 2.0, 0.2
    with thrown(0.3, wrist=(0.0, 0.1, 0.0)) as bench:
        tilt, dt = record(bench), bench.step_time
        tilt["roll"][1], tilt["sway"][1] = rate, sway
        y, z = 0.0, float(bench.plant.world["com"][0, 1])
        tilt["momentum"] = bench.box.mass * tilt["gyration"] * (rate, 0.0, 0.0)
        start = _from_frame(0.3, y, z)
        # at rest in the moving frame
        velocity = _from_frame(0.3, sway - rate * z, rate * y)
        origin = np.zeros(2)
        for k in range(60):
            bench.run(dt)
            time = (k + 1) * dt
            roll = 0.3 + rate * time
            # the origin sways along y, which turns
            origin = sway / rate * np.array([math.sin(roll) - math.sin(0.3), math.cos(0.3) - math.cos(roll)])
            _, y, z = bench.world.reading[0][0]
            seen = origin + _from_frame(roll, y, z)
            parabola = start + time * velocity - (0.0, 0.5 * bench.config.physics.gravity * time**2)
            worst = max(worst, float(np.linalg.norm(seen - parabola)))
    return 1e3 * worst


def _from_frame(roll: float, y: float, z: float) -> np.ndarray:
    """A vector of the rolled frame in space (y, z)."""
    return np.array([math.cos(roll) * y - math.sin(roll) * z, math.sin(roll) * y + math.cos(roll) * z])


def tilt() -> Iterator[Figure]:
    """With `physics.tilt`: static balance, oscillation, free motion."""
    yield from static()
    for axis, name in ((0, "x"), (2, "z")):
        yield Figure(f"tilt oscillation about {name}: against sqrt(2 K / I)", BOUND, oscillation(axis), "%")
    yield Figure("free fall in a rolled wrist", FREE_BOUND, max(falling(0.4), falling(-1.1)), "%")
    attitude, momentum = tumbling()
    yield Figure("thrown object: attitude against Euler's equations", FREE_BOUND, attitude, "%")
    yield Figure("thrown object: angular momentum", FREE_BOUND, momentum, "%")
    yield Figure("thrown object in a rolling, swaying frame, 0.5 s", 0.1, rolling_frame(), "mm")
