"""Finds what the slips of a whole episode tell at most, with a smoother that knows what no estimator does.

It fits the law of friction to all instants of an episode that "adaptive" learned from at once, with errors in
both force and velocity (Gauss-Newton; the true twist of every instant is an unknown of its own, as in
orthogonal distance regression: Boggs & Rogers, Contemporary Mathematics 112, 1990). It knows the limit
surface of the pads, that they are hard, their mu_s, sigma_2 and v_s, the structure of the sensors' errors and
how they are sampled: it lacks only mu_c, r and the errors of the episode. Readings that are lost, late by
chance or drift are noise to it, too.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import pandas as pd
from tqdm import tqdm

import policies
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.sliding import EVEN
from estimator.augmented.slip_law import COP, MILLIMETRE, MU, SHAPE, SIGMA, STATES, TILT, ZERO, R, predict
from estimator.augmented.timing import LAST
from policies.leaderboard.closed_loop import present
from policies.stepping import batch_steps
from slipgym.config import load
from slipgym.tasks import find

LEVER, MOMENT, SHIFT, LATE = STATES, STATES + 2, STATES + 3, STATES + 5
"""Index of what only the torque sees, an arm (2) [mm] and a moment over f_n [mm], of the place of the
velocity sensor beside the force sensor (2) [mm], and of the rest of the delay [samples]."""
UNKNOWNS = LATE + 1
KNOWN = 1e-4
"""Spread of an unknown that is known."""
UNIFORM = 3.0**-0.5
"""Standard deviation of an even distribution, over its half width."""
ZEROED = 0.03
"""Spread of the zero error [N] that is left after zeroing, and by its drift."""
LAW_ERROR = 0.02
"""Relative error of the law in an instant, for what is taken as exact: the time of a slide, its direction."""
FEWEST = 3
"""Instants that a fit needs."""
STEPS, LARGEST, CONVERGED = 40, 0.5, 1e-4
"""Steps of a fit at most; size of one in ln mu_c and ln r, and that of the last."""


class Slips(NamedTuple):
    """The instants of a finger's slips in an episode, and the truth at its end."""

    wrenches: np.ndarray
    """f_x, f_y, f_n, tau, (m, 4) [N, N, N, N m]."""
    before: np.ndarray
    """v_x, v_y, omega of the velocity sample before the instant, (m, 3)."""
    after: np.ndarray
    """The same after it."""
    zero: np.ndarray
    """Zero error that the unloaded sensor showed, (2,) [N]."""
    sign: float
    """As in `slip_law.predict`."""
    truth: dict[str, float]
    """mu_s, mu_c and r."""
    online: dict[str, float]
    """mu_c and r that "adaptive" published at the end."""


def slips(task: str, episodes: int, seed: int, **arguments: Any) -> list[Slips]:
    """Plays episodes with a task's controller on "adaptive", and keeps what it learns from.

    Args:
        task: Id of the environment.
        episodes: Rows of the batch, one episode each.
        seed: Of the first row.
        **arguments: Of the environments.

    Returns:
        Those of fingers with `FEWEST` instants or more.
    """
    policy = policies.make(find(task).key)
    env: Any = gym.make_vec(
        task, num_envs=episodes, estimator="adaptive", **policies.modes(policy), **arguments
    ).unwrapped
    observations, _ = env.reset(seed=seed)
    simulation, found = env.simulation, []
    zero = simulation.estimator.states["x"][:, ZERO:TILT].copy()
    rows: list[list[np.ndarray]] = [[] for _ in range(2 * episodes)]
    updates = simulation.estimator.states["updates_mu_c"].copy()
    for step in batch_steps(env, policy, observations):
        states = simulation.estimator.states
        running = np.repeat(step.running, 2)
        for i in np.flatnonzero(running & (states["updates_mu_c"] != updates)):
            if states[i]["slid"] == states[i]["samples"] - 1:
                rows[i].append(_instant(states[i]))
        updates = states["updates_mu_c"].copy()
        ended = np.flatnonzero(np.repeat(step.ended, 2))
        if ended.size:
            truth, estimates = present(simulation.plant.pads), simulation.estimator.estimates.ravel()
            for i in ended:
                if len(rows[i]) >= FEWEST:
                    true = {name: float(values.ravel()[i]) for name, values in truth.items()}
                    online = {name: float(estimates[i][name]) for name in ("mu_c", "r")}
                    wrenches, before, after = np.split(np.array(rows[i]), [4, 7], axis=1)
                    sign = float(states[i]["sign"])
                    found.append(Slips(wrenches, before, after, zero[i], sign, true, online))
    env.close()
    return found


def _instant(state: np.void) -> np.ndarray:
    """Wrench and both velocity samples of the newest instant that was learned from, (10,)."""
    k = int(state["samples"]) - 1
    wrench = state["wrenches"][(k - 2 - int(state["delay"])) & LAST]
    return np.concatenate([wrench, *(state["twists"][(k - back) & LAST] for back in (2, 1))]).astype(float)


def spreads(sensors: str) -> np.ndarray:
    """Standard deviations of the unknowns as a preset of the sensors samples them, (UNKNOWNS,)."""
    given, p = load(sensors=sensors).sensors.force_torque, AdaptiveParameters()
    found = np.full(UNKNOWNS, KNOWN)
    found[MU], found[R] = p.sd_log_mu_c0, p.sd_log_r0
    found[ZERO:TILT] = ZEROED if given.bias_tangential > 0.0 else KNOWN
    found[TILT:COP] = given.tilt * UNIFORM
    by_force = given.crosstalk * given.torque_range / given.force_range / MILLIMETRE * UNIFORM
    by_normal = given.crosstalk * given.torque_range / given.normal_range / MILLIMETRE * UNIFORM
    found[COP:SHAPE] = math.hypot(0.5 * by_force, by_normal)  # tangential over normal force is about one half
    found[LEVER:MOMENT], found[MOMENT] = by_force, by_normal
    found[SHIFT:LATE] = given.off_centre / MILLIMETRE * UNIFORM
    found[LATE] = 0.5 * UNIFORM if given.latency_spread > 0.0 else KNOWN
    return np.maximum(found, KNOWN)


def _law(
    p: np.void, x: np.ndarray, data: Slips, twists: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Measured f_x, f_y, tau (m, 3), with derivatives by the unknowns (m, 3, n) and the twists (m, 3, 3)."""
    m, static = len(twists), math.log(data.truth["mu_s"])
    wrenches, by_x, by_twist = np.zeros((m, 3)), np.zeros((m, 3, UNKNOWNS)), np.zeros((m, 3, 3))
    row = np.zeros((3, STATES))
    for i, (v_x, v_y, omega) in enumerate(twists.tolist()):
        f_n = data.wrenches[i, 2]
        shift_x, shift_y = MILLIMETRE * x[SHIFT], MILLIMETRE * x[SHIFT + 1]
        f_x, f_y, tau, _, _ = predict(
            p,
            x[:STATES],
            static,
            1.0,
            data.sign,
            f_n,
            v_x - omega * shift_y,
            v_y + omega * shift_x,
            omega,
            row,
            by_twist[i],
        )
        by_x[i, :, :STATES] = row
        by_x[i, :, SHIFT] = MILLIMETRE * omega * by_twist[i, :, 1]
        by_x[i, :, SHIFT + 1] = -MILLIMETRE * omega * by_twist[i, :, 0]
        by_twist[i, :, 2] += shift_x * by_twist[i, :, 1] - shift_y * by_twist[i, :, 0]
        by_x[i, 2, LEVER], by_x[i, 2, LEVER + 1] = MILLIMETRE * f_y, -MILLIMETRE * f_x
        by_x[i, 2, MOMENT] = MILLIMETRE * f_n
        wrenches[i] = f_x, f_y, tau + by_x[i, 2, LEVER:SHIFT] @ x[LEVER:SHIFT]
    return wrenches, by_x, by_twist


def smoothed(data: Slips, spread: np.ndarray, shape: float) -> tuple[np.ndarray, np.ndarray]:
    """Most probable unknowns (n,), and their covariance (n, n).

    Args:
        data: Of a finger.
        spread: From `spreads`.
        shape: Of the limit surface, 0 for a uniform disc and 1 for the ellipsoid.
    """
    parameters = AdaptiveParameters()
    p = parameters.as_array().view(np.recarray)[0]
    x = np.zeros(UNKNOWNS)
    x[MU], x[R], x[SIGMA] = math.log(p.mu_c0), math.log(p.r0), p.viscosity0
    x[ZERO:TILT], x[SHAPE] = data.zero, shape
    expected, prior = x.copy(), np.diag(spread**-2.0)
    measured, change = 0.5 * (data.before + data.after), data.after - data.before
    of_twist = 0.5 * np.array([p.sd_speed, p.sd_speed, p.sd_spin]) ** 2 + EVEN * change**2
    twists, y, f_n = measured.copy(), data.wrenches[:, [0, 1, 3]], data.wrenches[:, 2]
    least = np.diag([p.sd_force**2, p.sd_force**2, p.sd_torque**2])
    for _ in range(STEPS):
        f, by_x, by_twist = _law(p, x, data, twists)
        of_law = (p.sd_normal / f_n) ** 2 + LAW_ERROR**2
        noise = least + of_law[:, None, None] * f[:, :, None] * f[:, None, :]
        noise += np.einsum("mij,mj,mkj->mik", by_twist, of_twist, by_twist)
        by_x[:, :, LATE] = np.einsum("mij,mj->mi", by_twist, change)
        f += by_x[:, :, LATE] * x[LATE]
        off = y - f - np.einsum("mij,mj->mi", by_twist, measured - twists)
        weight = np.linalg.inv(noise)
        size = np.einsum("mi,mij,mj->m", off, weight, off)
        weight /= np.maximum(size / p.outlier, 1.0)[:, None, None]
        information = prior + np.einsum("mia,mij,mjb->ab", by_x, weight, by_x)
        slope = np.einsum("mia,mij,mj->a", by_x, weight, off) - prior @ (x - expected)
        step = np.linalg.solve(information, slope)
        largest = np.abs(step[:SIGMA]).max()
        step *= min(1.0, LARGEST / max(largest, 1e-9))
        x += step
        left = off - by_x @ step
        twists = measured + of_twist * np.einsum("mji,mjk,mk->mi", by_twist, weight, left)
        if largest < CONVERGED:
            break
    return x, np.linalg.inv(information)


def compared(episodes: int, seed: int, task: str = "slipgym/PlanarSlip-v0") -> pd.DataFrame:
    """Errors of "adaptive" at the ends of episodes, and of the smoother.

    Args:
        episodes: Of each combination of pads and sensors.
        seed: Of the first episode.
        task: Id of the environment.

    Returns:
        A row for each combination: the number of fingers, median sizes of the errors of mu_c and r of both
        [%], and the median errors that the smoother's covariance expects [%].
    """
    rows = []
    cells = [(contact, sensors) for contact in ("ellipsoid", "disc") for sensors in ("realistic", "lab")]
    for contact, sensors in tqdm(cells, desc="smoother"):
        found, spread = slips(task, episodes, seed, contact=contact, sensors=sensors), spreads(sensors)
        fits = [smoothed(data, spread, float(contact == "ellipsoid")) for data in found]
        row: dict[str, Any] = {"pads": contact, "sensors": sensors, "fingers": len(found)}
        for at, name in ((MU, "mu_c"), (R, "r")):
            off = [data.online[name] / data.truth[name] - 1.0 for data in found]
            fit = [math.exp(x[at]) / data.truth[name] - 1.0 for (x, _), data in zip(fits, found, strict=True)]
            stated = np.sqrt([covariance[at, at] for _, covariance in fits])
            row[f"{name} adaptive"] = 100.0 * np.median(np.abs(off))
            row[f"{name} smoother"] = 100.0 * np.median(np.abs(fit))
            row[f"{name} expected"] = 100.0 * _median_size(stated)
        rows.append(row)
    return pd.DataFrame(rows)


def _median_size(deviations: np.ndarray) -> float:
    """Median of the size of numbers that are normally distributed with these deviations, one each."""
    draws = np.random.default_rng(0).normal(size=(1000, len(deviations)))
    return float(np.median(np.abs(draws * deviations)))
