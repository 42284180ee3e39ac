"""Computes what each sensor preset shows of mu_c after a slip of 1 mm, and what an estimator makes of it.

An object hangs in the grip, which is lowered until it has slipped by a millimetre, and then closes. The bound
is that of a batch smoother which knows the whole record, the equations of the simulator and the commands, but
not friction, mass, the gain of the actuator, and the zero and scale errors of its sensors: the Bayesian
Cramér-Rao bound, from the record's derivatives by finite differences. Nothing estimates better in the mean.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

import gymnasium as gym
import numpy as np
import typer

import slipgym
from slipgym.config import load
from slipgym.config.sensors import SensorsConfig
from slipgym.sensors.markers import COUNT

PRESETS = "realistic", "lab", "markers", "wrist", "motor"
STEP = 0.01
"""Relative step of the derivatives."""
UNKNOWN = {"mu_c": 1.2, "ratio": 0.15, "mass": 1.0, "actuator": 0.1}
"""What the smoother does not know, and the deviation of its logarithm beforehand, as in "adaptive"."""
SLIP, REST, TASK = 1e-3, 40, "slipgym:slipgym/LinearSlip-v0"
LEAST, MOST = load().gripper.force_min, load().gripper.force_max


def drawn(rng: np.random.Generator) -> dict[str, float]:
    """Options of an episode: friction and mass as in the easy tasks; the grip holds at first."""
    mu_c, ratio, mass = rng.uniform(0.3, 0.8), rng.uniform(1.1, 1.5), rng.uniform(0.2, 0.5)
    force = min(1.3 * mass * 9.81 / (2.0 * mu_c * ratio), MOST)
    return {"mu_c": mu_c, "mu_s": ratio * mu_c, "object_mass": mass, "initial_force": force}


def actions(forces: np.ndarray) -> np.ndarray:
    """Actions (n, 1) for forces (n,) [N]."""
    return np.clip(2.0 * (forces[:, None] - LEAST) / (MOST - LEAST) - 1.0, -1.0, 1.0).astype(np.float32)


def slid(options: list[dict[str, Any]], follow: bool, seed: int, **made: Any) -> Any:
    """Lowers the grip of each object until it has slipped, the first one's or its own, and closes it.

    Args:
        options: Of each environment.
        follow: Whether all get the commands of the first.
        seed: Of the environments.
        made: Further arguments of the environments.

    Returns:
        Readings per step and environment, (t, n, 2, 4) and (t, n, 2, 3), and the environments' estimates.
    """
    n = len(options)
    envs = gym.make_vec(TASK, n, "vector_entry_point", action_mode="grip_force", **made)
    try:
        envs.reset(seed=seed, options={"rows": options})
        inner = envs.unwrapped.simulation  # type: ignore[attr-defined]
        forces = np.array([each["initial_force"] for each in options])
        caught, since, wrenches, twists = np.zeros(n, bool), 0, [], []
        while since < REST and len(wrenches) < 900:
            caught |= np.hypot(*inner.plant.world["slip"][:, :2].T) > SLIP
            if follow:
                caught[:] = caught[0]
            forces = np.where(caught, np.minimum(forces * 1.3, MOST), np.maximum(0.99 * forces, LEAST))
            envs.step(actions(forces))
            since += bool(caught.all())
            wrenches.append(inner.wrenches.copy())
            twists.append(inner.twists.copy())
        return np.array(wrenches), np.array(twists), inner.estimated.copy()
    finally:
        envs.close()


def readings(sensors: SensorsConfig, wrenches: np.ndarray, twists: np.ndarray) -> list[tuple[Any, ...]]:
    """Channels of a record (t, m) without errors: values, their noise, and derivatives by unknown errors.

    Args:
        sensors: The sensors.
        wrenches: True wrenches, (t, m, 2, 4).
        twists: True slip twists, (t, m, 2, 3).
    """
    force, motor, slip, markers = sensors.force_torque, sensors.motor, sensors.slip, sensors.markers
    normal, load, found = wrenches[..., 2].mean(axis=2), wrenches[..., 1].sum(axis=2), []
    if sensors.place != "fingers":
        one = normal[:, 0]
        noise = math.hypot(motor.noise, motor.resolution / math.sqrt(12.0))
        turned = np.where(np.diff(one, prepend=one[0]) < 0.0, -1.0, 1.0)
        errors = [(one, motor.gain_error / math.sqrt(3.0)), (one * turned, motor.friction)]
        found.append((normal, noise, errors))
        if sensors.place == "wrist":
            zero = math.sqrt(2.0) * force.bias_tangential
            found.append((load, math.sqrt(2.0) * force.noise_tangential, [(np.ones(len(one)), zero)]))
        return found
    every = sensors.interval
    for f in range(2):
        load, normal, speed = wrenches[::every, :, f, 1], wrenches[::every, :, f, 2], twists[::every, :, f, 1]
        ones = np.ones(len(load))
        zeros, zero_n = [(ones, force.bias_tangential)], [(ones, force.bias_normal)]
        noise, noise_v = force.noise_tangential, slip.count * slip.rate / math.sqrt(12.0 * slip.chips)
        if markers is not None:
            noise = math.sqrt(COUNT) * markers.noise / markers.compliance
            zeros.append((load[:, 0], markers.gain_error / math.sqrt(3.0)))
            zero_n.append((normal[:, 0], markers.normal_error / math.sqrt(3.0)))
            noise_v = slip.noise * slip.count * slip.rate / (slip.window * math.sqrt(slip.chips / 2.0))
        tilt = [(load[:, 0], force.crosstalk + force.tilt)] if force.tilt > 0.0 else []
        found += [(load, noise, zeros), (normal, force.noise_normal, zero_n + tilt)]
        found.append((speed, noise_v, [(speed[:, 0], slip.scale_error / math.sqrt(3.0))]))
    return found


def bound(sensors: SensorsConfig, wrenches: np.ndarray, twists: np.ndarray, trusted: bool) -> float:
    """Least standard deviation of ln mu_c.

    Args:
        sensors: The sensors.
        wrenches: True wrenches (t, 1 + 2 u, 2, 4), the nominal world first, then each unknown up and down.
        twists: True slip twists, likewise.
        trusted: Whether the gain of the actuator is known.
    """
    channels = readings(sensors, wrenches, twists)
    priors = [*UNKNOWN.values()]
    if trusted:
        priors[-1] = 1e-6
    errors = [error for *_, each in channels for error in each if error[1] > 0.0]
    information = np.diag([1.0 / prior**2 for prior in (*priors, *(sd for _, sd in errors))])
    first = len(priors)
    for values, noise, own in channels:
        rows = np.zeros((len(values), len(information)))
        rows[:, : len(priors)] = (values[:, 1::2] - values[:, 2::2]) / (2.0 * STEP)
        for derivative, sd in own:
            if sd > 0.0:
                rows[:, first] = derivative
                first += 1
        information += rows.T @ rows / max(noise, 1e-9) ** 2
    return float(np.sqrt(np.linalg.inv(information)[0, 0]))


def worlds(options: dict[str, float]) -> list[dict[str, Any]]:
    """Options of the nominal world and of each unknown up and down by STEP."""
    rows: list[dict[str, Any]] = [{**options, "force_gain": [1.0, 1.0]}]
    for name in UNKNOWN:
        for sign in (1.0, -1.0):
            factor, row = math.exp(sign * STEP), dict(rows[0])
            for key in {"mu_c": ("mu_c", "mu_s"), "ratio": ("mu_s",), "mass": ("object_mass",)}.get(name, ()):
                row[key] *= factor
            rows.append({**row, "force_gain": [factor, factor]} if name == "actuator" else row)
    return rows


def main(
    episodes: Annotated[int, typer.Option(min=2, help="Objects of other friction and mass.")] = 40,
    seed: Annotated[int, typer.Option(min=0, help="Of the draws.")] = 0,
) -> None:
    """Print for each preset the bound of mu_c after a slip of 1 mm, and what "adaptive" states and errs."""
    rng = np.random.default_rng(seed)
    options = [drawn(rng) for _ in range(episodes)]
    kept: dict[str, list[tuple[float, float]]] = {name: [] for name in PRESETS}
    for row in options:
        wrenches, twists, _ = slid(worlds(row), True, seed, sensors="ideal", estimator=None)
        for name in PRESETS:
            sensors = load(sensors=name).sensors
            kept[name].append(
                (bound(sensors, wrenches, twists, True), bound(sensors, wrenches, twists, False))
            )
    typer.echo(f"slipgym {slipgym.__version__}, {episodes} objects, slip of {1e3 * SLIP:g} mm; medians [%]")
    typer.echo(f"{'sensors':10} {'bound':>8} {'actuator unknown':>17} {'adaptive errs':>14} {'states':>8}")
    true = np.array([row["mu_c"] for row in options])
    for name in PRESETS:
        estimated = slid(options, False, seed, sensors=name)[2]
        errors = np.abs(np.log(estimated[:, 1] / true))
        figures = (
            *np.median(kept[name], axis=0),
            np.median(errors),
            np.median(estimated[:, 7] / estimated[:, 1]),
        )
        cells = (f"{100.0 * value:.1f}" for value in figures)
        typer.echo("{:10} {:>8} {:>17} {:>14} {:>8}".format(name, *cells))
