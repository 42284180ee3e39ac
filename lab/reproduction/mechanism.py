"""Explains why the plain estimator reads mu_c low: samples called moving that are stuck, and their weight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from estimator.rls import RlsParameters
from lab.reproduction.records import Record

STILL = 1e-4  # [m/s]; a tenth of the Stribeck velocity, and ten times the elastic motion of a stuck contact
_TABLE_1 = RlsParameters()
_AFTER = 6  # samples after a slip in which the grip still rises: its lag and dead time, and a halt's length


def truly_sliding(record: Record) -> np.ndarray:
    """Whether the contact slides at the instant of each sample, (T,) bool."""
    return np.linalg.norm(_scaled(record.slip_twist, record), axis=-1) > STILL


def called_moving(record: Record) -> np.ndarray:
    """Whether the measured speed, with the true r, exceeds eps_v, (T, 2) bool."""
    return np.linalg.norm(_scaled(record.twists, record), axis=-1) > _TABLE_1.eps_v


def slips(record: Record) -> np.ndarray:
    """First sample and first sample after each slip of the contact, (n, 2)."""
    edges = np.diff(truly_sliding(record).astype(int), prepend=0, append=0)
    return np.column_stack((np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)))


def rises(record: Record) -> np.ndarray:
    """Fastest measured rise of f_n in each slip and shortly after, larger of the fingers, (n,) [N/s]."""
    rate = np.diff(record.wrenches[..., 2], axis=0, prepend=record.wrenches[:1, :, 2]).max(axis=1)
    rate /= record.time[1] - record.time[0]
    return np.array([rate[begin : end + _AFTER].max() for begin, end in slips(record)])


def summary(records: Sequence[Record]) -> dict[str, Any]:
    """What the samples of several trials are made of.

    Returns:
        `moving`: samples called moving, both fingers; `stuck_share` of them that are stuck;
        `f_n_stuck`, `f_n_sliding`: mean normal force of either kind [N]; `weight_stuck`: the stuck
        samples' share of sum (gamma_t f_n)^2, the weight in the least squares; `fit_all`, `fit_sliding`:
        mu_c over its truth by least squares over all samples called moving, and over those that slide;
        `slips`, `slip_ms`: how many and how long on average, counted at the samples; `rise_N_s`: median of
        the fastest rise of f_n; `fast_share`: share of slips that rise faster than eps_delta;
        `gamma_t`: median true one while sliding; `slid_mm`, `turned_deg`: mean size of the displacement
        at the trial's end.
    """
    parts = zip(*map(_moving_samples, records), strict=True)
    f_n, phi, y, stuck = (np.concatenate(part) for part in parts)
    lengths = np.concatenate([np.diff(slips(r))[:, 0] * (r.time[1] - r.time[0]) for r in records])
    rise = np.concatenate([rises(record) for record in records])
    return {
        "moving": len(stuck),
        "stuck_share": stuck.mean(),
        "f_n_stuck": f_n[stuck].mean() if stuck.any() else np.nan,
        "f_n_sliding": f_n[~stuck].mean(),
        "weight_stuck": (phi[stuck] ** 2).sum() / (phi**2).sum(),
        "fit_all": (phi * y).sum() / (phi**2).sum(),
        "fit_sliding": (phi * y)[~stuck].sum() / (phi[~stuck] ** 2).sum(),
        "slips": len(lengths),
        "slip_ms": 1e3 * lengths.mean(),
        "rise_N_s": np.median(rise),
        "fast_share": (rise > _TABLE_1.eps_delta).mean(),
        "gamma_t": np.median(np.concatenate([_gamma_t(_sliding_twists(record)) for record in records])),
        "slid_mm": 1e3 * np.mean([np.hypot(*record.slip[-1, :2]) for record in records]),
        "turned_deg": np.degrees(np.mean([abs(record.slip[-1, 2]) for record in records])),
    }


def _moving_samples(record: Record) -> tuple[np.ndarray, ...]:
    """f_n, gamma_t f_n, f_t over the true mu_c, and whether stuck, of all samples called moving."""
    moving = called_moving(record)
    twist, (f_x, f_y, f_n, _) = _scaled(record.twists, record)[moving], record.wrenches[moving].T
    stuck = np.repeat(~truly_sliding(record)[:, None], 2, axis=1)[moving]
    return f_n, _gamma_t(twist) * f_n, np.hypot(f_x, f_y) / record.truth[1], stuck


def _sliding_twists(record: Record) -> np.ndarray:
    return _scaled(record.slip_twist[truly_sliding(record)], record)


def _gamma_t(twist: np.ndarray) -> np.ndarray:
    return np.hypot(twist[:, 0], twist[:, 1]) / np.linalg.norm(twist, axis=1)


def _scaled(twist: np.ndarray, record: Record) -> np.ndarray:
    return twist * (1.0, 1.0, record.truth[2])
