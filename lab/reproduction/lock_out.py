"""Finds the start values and slips from which an estimator never finds the truth."""

from __future__ import annotations

import numpy as np
from tqdm import tqdm

import estimator
from estimator.limit_surface import slip_friction
from lab.reproduction.fixed_point import Slip

RATE = 120.0
SAMPLES = 360  # 3 s of slip


def errors(name: str, gammas: np.ndarray, radii: np.ndarray, f_n: float, progress: bool = True) -> np.ndarray:
    """Worse of the relative errors of mu_c and r after 3 s of exact slip on the estimator's own surface.

    Args:
        name: Estimator; its parameters but r0 are the defaults.
        gammas: True gamma_t of the slips, (m,).
        radii: Start values r0, (k,) [m].
        f_n: Normal force [N].
        progress: Whether to show a progress bar.

    Returns:
        (k, m) [-]; the truth is that of `Slip`.
    """
    slips = [Slip(gamma_t=float(c), f_n=f_n) for c in gammas]
    twist = np.array([[s.v_t, 0.0, s.omega] for s in slips])
    n = len(radii) * len(gammas)
    batch = estimator.make_batch(name, n)
    on_disc = getattr(batch.parameters, "disc", False)
    shares = [slip_friction(on_disc, s.v_t, s.r * s.omega) for s in slips]
    wrench = np.array(
        [
            [a * s.mu_c * f_n, 0.0, f_n, b * s.mu_c * f_n * s.r]
            for s, (a, b) in zip(slips, shares, strict=True)
        ]
    )
    batch.parameters_array = np.repeat(batch.parameters_array, n)
    batch.parameters_array["r0"] = np.repeat(radii, len(gammas))
    batch.reset()
    wrenches, twists = np.tile(wrench, (len(radii), 1)), np.tile(twist, (len(radii), 1))
    label = f"{name}, {f_n:g} N"
    for k in tqdm(range(1, SAMPLES + 1), desc=label, unit="sample", leave=False, disable=not progress):
        batch.update(k / RATE, wrenches, twists)
    mu_c, r = (batch.estimates[field].reshape(len(radii), -1) for field in ("mu_c", "r"))
    return np.maximum(np.abs(mu_c / slips[0].mu_c - 1.0), np.abs(r / slips[0].r - 1.0))
