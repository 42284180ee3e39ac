"""Records for tests, from simulations that share nothing with the estimators or the environments."""

import numpy as np
import pandas as pd
import pytest

from estimator.records import load_columns
from slipgym.synthetic import Record

MU_C, R = 0.4, 0.012

WEAK = {
    "test_stick_slip_with_a_delay_that_nobody_tells[2-0.3]": "stick-slip late and with jitter",
    "test_stick_slip_with_a_delay_that_nobody_tells[4-0.0]": "stick-slip four samples late",
    "test_stick_slip_with_a_delay_that_nobody_tells[4-0.3]": "stick-slip four samples late",
    "test_short_slips_teach_mu_c_whatever_the_delay[0.25-0-0.0]": "the start value pulls by 4 %",
    "test_short_slips_teach_mu_c_whatever_the_delay[0.25-0-0.3]": "the start value pulls by 4 %",
    "test_short_slips_teach_mu_c_whatever_the_delay[0.25-1-0.3]": "one late sample is taken for an exponent",
    "test_short_slips_teach_mu_c_whatever_the_delay[0.25-3-0.3]": "one late sample is taken for an exponent",
    "test_short_slips_teach_mu_c_whatever_the_delay[0.5-3-0.3]": "short slips late and with jitter",
    "test_mu_s_does_not_follow_a_mu_c_that_a_spring_misleads[0.00025-1.0]": "the softest pad",
    "test_mu_s_does_not_follow_a_mu_c_that_a_spring_misleads[0.00025-2.0]": "the softest pad",
    "test_deviations_fall_when_the_motion_shows_the_errors": "by 0.63, not by 0.5",
    "test_mu_s_follows_a_stick_that_contradicts_it": "4 % instead of 2 % off after two events",
    "test_it_follows_a_load_that_swings[0.0-0.0]": "3 to 5 % rms instead of 1.5 %",
    "test_it_follows_a_load_that_swings[0.15-0.0]": "3 to 5 % rms instead of 1.5 %",
    "test_it_follows_a_load_that_swings[0.31-0.3333333333333333]": "3 to 5 % rms instead of 1.5 %",
    "test_the_deviation_grows_with_another_load_and_holds_both_kinds_of_pads": "it grows too little",
    "test_slips_slower_than_the_stribeck_velocity[wood-disc-0.0003-0.4]": "11 % instead of 10 %",
    "test_pushes_of_a_millimetre_are_slips_whatever_is_held_between_them[True-0.0022-15.0-0.0]": (
        "38 % instead of 10 %: turns of a patch of a seventh of r_max may be springs"
    ),
    "test_a_pad_that_springs_in_torsion_does_not_slip": "a spring in torsion is taken for slip",
}
"""What "adaptive" is known not to reach: test -> how far off it is. One that passes again fails the suite."""


def pytest_collection_modifyitems(items):
    for item in items:
        if item.name in WEAK:
            item.add_marker(pytest.mark.xfail(reason=WEAK[item.name], strict=True))


@pytest.fixture
def table():
    """A slide and turn on an ellipsoid of 2 s, forces at 1000 Hz, velocities at 120 Hz; NaN: no sample."""
    rng = np.random.default_rng(0)
    t = np.arange(1, 2001) / 1000
    f_n = 5.0 + 0.5 * np.sin(2 * np.pi * t)
    share = MU_C * f_n / np.sqrt(2.0)  # as much sliding as turning
    forces = pd.DataFrame({"t": t, "f_x": 0.0 * t, "f_y": share, "f_n": f_n, "tau": R * share})
    forces[["f_x", "f_y", "f_n"]] += 0.01 * rng.standard_normal((len(t), 3))
    at = np.arange(1, 241) / 120
    twists = pd.DataFrame({"t": at.round(6), "v_x": 0.0, "v_y": 0.02, "omega": 0.02 / R})
    return forces.assign(t=t.round(6)).merge(twists, how="outer", on="t", sort=True)


@pytest.fixture
def save(tmp_path):
    """Writes a table to a file, by the type in its name."""

    def write(frame, name="log.csv"):
        path = tmp_path / name
        if name.endswith(".parquet"):
            frame.to_parquet(path, index=False)
        else:
            frame.to_csv(path, index=False)
        return path

    return write


@pytest.fixture
def mapping(tmp_path):
    """Reads a mapping of columns from a text."""

    def read(text):
        (tmp_path / "mapping.yaml").write_text(text, encoding="utf-8")
        return load_columns(tmp_path / "mapping.yaml")

    return read


WRENCH_NOISE = np.array([0.02, 0.02, 0.04, 5e-4])  # [N, N, N, N m]
COUNT, CHIP_RADIUS = 7.94e-6, 0.0243  # [m]
SUBSTEPS = 40


def sensed(wrench, motion, fingers, rng, **truth):
    """A record of several fingers: noise on wrench (n, 4), counts of three chips from motion (n, 3)."""
    n = len(wrench)
    angles = np.pi / 2 + 2 * np.pi / 3 * np.arange(3)
    at = CHIP_RADIUS * np.stack([np.cos(angles), np.sin(angles)])
    path = np.cumsum(motion, axis=0)
    axes = np.concatenate([path[:, :1] - path[:, 2:] * at[1], path[:, 1:2] + path[:, 2:] * at[0]], axis=1)
    rest = rng.random((fingers, 1, 6))
    counts = np.diff(np.floor(axes / COUNT + rest), axis=1, prepend=np.floor(rest)) * COUNT
    x, y = counts[..., :3], counts[..., 3:]
    spin = (at[0] * y - at[1] * x).sum(axis=-1) / (3 * CHIP_RADIUS**2)
    return Record(
        t=np.arange(1, n + 1) / 120,
        wrenches=wrench + WRENCH_NOISE * rng.standard_normal((fingers, n, 4)),
        twists=120 * np.stack([x.mean(axis=-1), y.mean(axis=-1), spin], axis=-1),
        **{name: np.full(n, values) for name, values in truth.items()},
    )


@pytest.fixture(scope="session")
def planar_slip():
    """Makes records of a planar slip at 20 mm/s: cells of dry and viscous friction, no bristles.

    Args: `turn` [rad/s] of the direction of the slip, `jump` of mu_c after 2 s, `fingers`, `hertz` pressure;
    `scatter`: relative error of each component of a sample's load, which is also that of another twist:
    `turned` times the scatter away.
    """

    def make(
        turn=1.0,
        jump=1.0,
        fingers=8,
        hertz=False,
        gamma_t=0.7,
        sigma_2=0.2,
        seed=0,
        r=0.008,
        f_n=5.0,
        scatter=0.0,
        turned=2.0,
    ):
        rng, n = np.random.default_rng(seed), 420

        def twist(t):
            speed = 0.02 * np.clip((t - 0.25) / 0.25, 0, 1)
            across = gamma_t * speed
            omega = np.sqrt(1 - gamma_t**2) * speed / r
            return np.stack([across * np.cos(turn * t), across * np.sin(turn * t), omega], axis=-1)

        rings = (np.arange(60) + 0.5) / 60
        weight = rings * (np.sqrt(1 - rings**2) if hertz else 1.0)
        radius = rings * r * (16 / (3 * np.pi) if hertz else 1.5)
        angle = 2 * np.pi * (np.arange(48) + 0.5) / 48
        x, y = (np.outer(radius, trig(angle)).ravel() for trig in (np.cos, np.sin))
        share = np.repeat(weight / weight.sum() / 48, 48)
        t = np.arange(1, n + 1) / 120
        mu_c = 0.4 * np.where(t > 2.0, jump, 1.0)
        slip = twist(t)
        other = turned * scatter * rng.standard_normal((n, 3)) if scatter else 0.0
        slip = slip + other * np.hypot(np.linalg.norm(slip[:, :2], axis=1), r * slip[:, 2])[:, None] / [
            1,
            1,
            r,
        ]
        v_x, v_y = slip[:, :1] - slip[:, 2:] * y, slip[:, 1:2] + slip[:, 2:] * x
        speed = np.hypot(v_x, v_y)
        dry = mu_c[:, None] * (1 + 0.35 * np.exp(-((speed / 1e-3) ** 2))) / np.maximum(speed, 1e-9)
        per_cell = f_n * share * (dry + sigma_2)
        parts = ((per_cell * v_x), (per_cell * v_y), np.full((n, 1), f_n), per_cell * (x * v_y - y * v_x))
        fine = (np.arange(n * SUBSTEPS) + 0.5) / (120 * SUBSTEPS)
        motion = twist(fine).reshape(n, SUBSTEPS, 3).mean(axis=1) / 120
        wrench = np.stack([part.sum(axis=1) for part in parts], axis=1)
        if scatter:
            wrench[:, [0, 1, 3]] += (
                scatter
                * np.stack([np.hypot(*wrench[:, :2].T)] * 2 + [abs(wrench[:, 3])], axis=1)
                * rng.standard_normal((n, 3))
            )
        return sensed(wrench, motion, fingers, rng, mu_c=mu_c, mu_s=1.35 * mu_c, r=r, phase="planar")

    return make


@pytest.fixture(scope="session")
def stick_slip():
    """Makes records of a block that hangs in a grip, which loosens in stick and closes on a slip.

    Integrated in steps of 0.1 ms: m dv/dt = m g - (mu_c + sigma_2 v) f_n in slip, a lag of 12 ms of f_n.
    """

    def make(mu_c=0.4, mu_s=0.55, fingers=8, seed=0, seconds=5.0, sigma_2=0.2, mass=0.1, gain=60.0):
        rng, steps = np.random.default_rng(seed), 83
        n, dt = int(seconds * 120), 1 / (120 * 83)
        v, f_n, command, f_t, seen = 0.0, 3.5, 3.5, mass * 9.81, [0.0] * 3
        wrench, motion, slid = np.zeros((n, 4)), np.zeros((n, 3)), np.zeros(n, bool)
        for k in range(n):
            command = 0.94 * command + gain * seen[-3] * (1 + 0.2 * rng.random())
            command = min(max(command, 0.8), 12.0)
            for _ in range(steps):
                f_n += (command - f_n) * dt / 0.012
                if v > 0.0 or mass * 9.81 > mu_s * f_n:
                    f_t = (mu_c + (mu_s - mu_c) * np.exp(-((v / 1e-3) ** 2)) + sigma_2 * v) * f_n
                    v = max(v + (9.81 - f_t / mass) * dt, 0.0)
                if v == 0.0:
                    f_t = mass * 9.81
                motion[k, 1] += v * dt
            seen.append(v)
            wrench[k] = 0.0, f_t, f_n, 0.0
            slid[k] = motion[k, 1] > 1e-3 / 120
        phase = np.where(slid, "slip", "stick")
        return sensed(wrench, motion, fingers, rng, mu_c=mu_c, mu_s=mu_s, r=0.008, phase=phase)

    return make


@pytest.fixture(scope="session")
def short_slips():
    """Makes records of a block whose grip is lowered until it slips, and then closed, again and again.

    Integrated as `stick_slip`. The grip closes at the second sample of a slip.
    """

    def make(mu_c=0.4, mu_s=0.55, fingers=8, seed=0, seconds=4.0, sigma_2=0.2, mass=0.1):
        rng, steps = np.random.default_rng(seed), 83
        n, dt = int(seconds * 120), 1 / (120 * 83)
        v, seen, f_n, f_t, level, rest = 0.0, 0.0, 3.0, mass * 9.81, 3.0, 0
        wrench, motion = np.zeros((n, 4)), np.zeros((n, 3))
        for k in range(n):
            rest = max(rest - 1, 0)
            if seen > 0.0 and not rest:
                level, rest = 1.6 * f_n, 20
            level *= 1.0 if rest else 0.97 + 0.005 * rng.random()
            command, seen = 4.0 * level if seen > 0.0 else level, v
            for _ in range(steps):
                f_n += (command - f_n) * dt / 0.012
                if v > 0.0 or mass * 9.81 > mu_s * f_n:
                    f_t = (mu_c + (mu_s - mu_c) * np.exp(-((v / 1e-3) ** 2)) + sigma_2 * v) * f_n
                    v = max(v + (9.81 - f_t / mass) * dt, 0.0)
                if v == 0.0:
                    f_t = mass * 9.81
                motion[k, 1] += v * dt
            wrench[k] = 0.0, f_t, f_n, 0.0
        phase = np.where(motion[:, 1] > 1e-3 / 120, "slip", "stick")
        return sensed(wrench, motion, fingers, rng, mu_c=mu_c, mu_s=mu_s, r=0.008, phase=phase)

    return make
