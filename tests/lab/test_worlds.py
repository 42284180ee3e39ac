"""The independent worlds: friction against closed forms, energy, sensors, truth and counting of errors."""

import ast
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import lab.worlds
from lab.commands.fuzz import app
from lab.worlds import drawn, errors, simulate, table
from lab.worlds.body import GRAVITY, START, hold
from lab.worlds.draw import GROUPS, MOTIONS
from lab.worlds.friction import Law, at_load, elastic, friction
from lab.worlds.pad import pad
from lab.worlds.run import misleads
from lab.worlds.scenario import Sensors
from lab.worlds.sensing import sample_steps, twists, wrenches
from lab.worlds.world import simulate_trace

LAW = Law(stribeck=1e-3, sigma_0=1e5, sigma_1=60.0, sigma_2=0.0)
SOFT = LAW._replace(compliance=2e-4)
SHAPES = "disc", "hertz", "ring", "ellipsoid"
MU_C, MU_S, R, F_N, H = 0.5, 0.6, 0.008, 10.0, 1e-4
PERFECT = Sensors(120, 0, 0.0, 0.0, False, 0.0, 0.0, 1, (0.0,) * 4, (0.0, 0.0), (0.0, 0.0), 1.0, (0.0, 0.0))


def pulled(shape, law, motion, f_n=F_N):
    """Friction (n, 3), slip (n, 3) and elastic energy (n,) of a pad under twists (n, 3)."""
    made = pad(shape)
    z, out, here = np.zeros((max(1, len(made.weights)), 3)), np.zeros(6), at_load(law, f_n, MU_C, MU_S, R)
    rows, stored = [], []
    for twist in motion:
        friction(z, made, law, here, twist, H, out)
        rows.append(out.copy())
        stored.append(elastic(z, made, law, f_n))
    return np.array(rows)[:, :3], np.array(rows)[:, 3:], np.array(stored)


def steady(shape, twist, law=LAW, f_n=F_N):
    """Friction after a long slip, over mu_c f_n and r: (3,)."""
    found = pulled(shape, law, np.tile(twist, (8000, 1)), f_n)[0][-1]
    return found / (MU_C * f_n * np.array([1.0, 1.0, R]))


def integrated(shape, twist):
    """The same by integration of the pressure over the pad, r times its radius over the radius."""
    n = 400
    s = (np.arange(n) + 0.5) / n if shape != "ring" else np.ones(1)
    weight = {"disc": s, "hertz": s * np.sqrt(1.0 - s**2), "ring": s}[shape]
    a = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    x, y = np.outer(s, np.cos(a)), np.outer(s, np.sin(a))
    load = np.repeat(weight[:, None], n, axis=1) / (n * weight.sum())
    radius = R / float((load * np.hypot(x, y)).sum())
    v_x, v_y = twist[0] - twist[2] * radius * y, twist[1] + twist[2] * radius * x
    size = np.hypot(v_x, v_y)
    f_x, f_y = -(load * v_x / size), -(load * v_y / size)
    return np.array([f_x.sum(), f_y.sum(), radius * (x * f_y - y * f_x).sum() / R])


def test_the_mean_distance_of_the_load_is_that_of_the_pressure():
    assert pad("disc").ratio == pytest.approx(2.0 / 3.0)
    assert pad("hertz").ratio == pytest.approx(3.0 * np.pi / 16.0)
    assert pad("ring").ratio == pad("ellipsoid").ratio == 1.0
    for shape in SHAPES[:3]:
        assert pad(shape).weights.sum() == pytest.approx(1.0)
        assert pad(shape).areas.sum() == pytest.approx(1.0)
        np.testing.assert_allclose(pad(shape).weights @ pad(shape).places, 0.0, atol=1e-12)
    with pytest.raises(ValueError, match="'square'; valid: disc, hertz, ring, ellipsoid"):
        pad("square")


@pytest.mark.parametrize("law", [LAW, SOFT], ids=["rigid", "soft"])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_slide_shows_mu_and_a_spin_mu_r(shape, law):
    """For a disc of radius R the spin is 2/3 mu f_n R."""
    np.testing.assert_allclose(steady(shape, (0.012, -0.016, 0.0), law), (-0.6, 0.8, 0.0), atol=1e-3)
    np.testing.assert_allclose(steady(shape, (0.0, 0.0, 3.0), law), (0.0, 0.0, -1.0), atol=1e-3)


@pytest.mark.parametrize("turns", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("shape", ["disc", "hertz", "ring"])
def test_a_mixed_slip_is_that_of_the_integral(shape, turns):
    twist = (0.02, 0.0, turns * 0.02 / R)
    np.testing.assert_allclose(steady(shape, twist), integrated(shape, twist), atol=0.02)


def test_a_mixed_slip_of_the_ellipsoid_has_the_direction_of_the_scaled_twist():
    twist = np.array([0.01, 0.02, -0.02 / R])
    np.testing.assert_allclose(steady("ellipsoid", twist), -np.array([1.0, 2.0, -2.0]) / 3.0, atol=1e-3)


def test_friction_differs_between_the_axes():
    law = LAW._replace(stretch=0.1)
    for shape in SHAPES:
        assert steady(shape, (0.02, 0.0, 0.0), law)[0] == pytest.approx(-1.1, abs=2e-3)
        assert steady(shape, (0.0, 0.02, 0.0), law)[1] == pytest.approx(-0.9, abs=2e-3)


@pytest.mark.parametrize("shape", SHAPES)
def test_friction_and_radius_follow_the_load(shape):
    law = LAW._replace(falls=0.3, grows=0.2, reference=5.0)
    assert steady(shape, (0.02, 0.0, 0.0), law)[0] == pytest.approx(-(2.0**-0.3), abs=2e-3)
    assert steady(shape, (0.0, 0.0, 4.0), law)[2] == pytest.approx(-(2.0**-0.1), abs=2e-3)
    assert at_load(law, 5.0, MU_C, MU_S, R) == (5.0, MU_C, MU_S, R)


@pytest.mark.quick_cases("disc-rigid", "hertz-soft", "ring-soft", "ellipsoid-rigid", "ellipsoid-soft")
@pytest.mark.parametrize("law", [LAW, SOFT], ids=["rigid", "soft"])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_pad_gives_no_energy(shape, law):
    """The work done on it in a step is never less than what its bristles and springs take."""
    rng = np.random.default_rng(3)
    motion = np.repeat(rng.normal(0.0, 1.0, (400, 3)) * (0.01, 0.01, 1.0), 100, axis=0)
    motion *= np.repeat(rng.choice([0.01, 0.1, 1.0], 400), 100)[:, None]
    found, _, stored = pulled(shape, law, motion)
    work = np.cumsum(-(found * motion).sum(axis=1)) * H
    assert stored.max() > 1e-5
    assert np.diff(work - stored).min() >= -1e-9 * stored.max()
    assert (work - stored)[-1] > 3.0 * stored.max()


@pytest.mark.quick_cases("disc", "ellipsoid")
@pytest.mark.parametrize("shape", SHAPES)
def test_a_soft_pads_object_moves_before_it_slips(shape):
    """By compliance times force, and in torsion by compliance times torque over the springs' mean square."""
    made, bristle = pad(shape), 1.0 / (LAW.sigma_0 * F_N)
    square = made.areas @ (made.places**2).sum(axis=1) / made.ratio**2 if len(made.areas) else 1.0
    for axis, inertia, speed in ((0, 1.0, 1e-3), (2, R * R * square, 1e-3 / R)):
        motion = np.zeros((80000, 3))
        motion[:, axis] = speed
        found, slip, _ = pulled(shape, SOFT, motion)
        limit = MU_C * F_N * (R if axis else 1.0)
        half = int(np.argmax(np.abs(found[:, axis]) > 0.25 * limit))
        moved = speed * H * (half + 1)
        expected = (SOFT.compliance + bristle) / inertia * abs(found[half, axis])
        assert moved == pytest.approx(expected, rel=0.08)  # the cells of a loaded pad differ in stiffness
        assert np.abs(slip[: half // 2, axis]).max() < 1e-3 * speed
        assert slip[-1, axis] == pytest.approx(speed, rel=0.02)
    rigid, _, _ = pulled(shape, LAW, np.tile((1e-4, 0.0, 0.0), (500, 1)))
    assert abs(rigid[-1, 0]) > 0.9 * MU_C * F_N  # a rigid one holds the limit after 5 um already


def test_a_spring_unwinds_when_the_load_falls():
    made = pad("ellipsoid")
    z, out = np.zeros((1, 3)), np.zeros(6)
    for f_n in (10.0, 2.0):
        here = at_load(SOFT, f_n, MU_C, MU_S, R)
        for _ in range(20000):
            friction(z, made, SOFT, here, ((1e-3, 0.0, 0.0) if f_n > 5.0 else (0.0, 0.0, 0.0)), H, out)
    assert abs(out[0]) == pytest.approx(MU_S * 2.0, rel=1e-6)


@pytest.mark.quick_cases(*(motion for motion in MOTIONS if motion != "course"))
@pytest.mark.parametrize("motion", MOTIONS)
def test_a_seed_always_makes_the_same_world(motion):
    seed = next(seed for seed in range(10000, 10200) if drawn(seed).motion == motion)
    first, again = (simulate(drawn(seed)) for _ in range(2))
    for name in ("t", "wrenches", "twists"):
        np.testing.assert_array_equal(getattr(first, name), getattr(again, name))
    assert first.marks == again.marks
    other = simulate(replace(drawn(seed), seed=seed + 1))
    assert not np.array_equal(first.wrenches[:100], other.wrenches[:100])


def test_a_held_body_is_carried_by_both_pads():
    scenario = next(found for found in map(drawn, range(10000, 10200)) if found.motion == "leaps")
    scenario = replace(scenario, opened=False)
    trace, held = simulate_trace(scenario), hold(scenario, np.random.default_rng([scenario.seed, 2]))
    at = int(START * trace.rate) - 1
    carried = np.hypot(*trace.friction[at, :2])
    assert 2.0 * carried == pytest.approx(held.body.mass * GRAVITY, rel=1e-2)


@pytest.mark.parametrize("motion", ["mixed", "leaps"])
def test_sensors_without_errors_read_the_trace(motion):
    scenario = next(found for found in map(drawn, range(10000, 10200)) if found.motion == motion)
    trace, rng = simulate_trace(scenario), np.random.default_rng(0)
    for sign in (1, -1):
        sensors = replace(PERFECT, sign=sign)
        steps = sample_steps(trace, sensors, rng)
        read, seen = (f(trace, sensors, steps, rng) for f in (wrenches, twists))
        signals = np.column_stack((sign * trace.friction, trace.normal))[:, [0, 1, 3, 2]]
        ages = np.arange(trace.rate // 1000)[:, None]  # up to 1 ms old
        recent = signals[np.maximum(steps - ages, 0)]
        assert (np.abs(recent - read).max(axis=2).min(axis=0) == 0.0).all()
        path = np.cumsum(seen, axis=0) / 120.0
        np.testing.assert_allclose(path[-1], trace.twist[: steps[-1] + 1].sum(axis=0) / trace.rate, atol=1e-9)
        late = twists(trace, replace(sensors, latency=2), steps, rng)
        np.testing.assert_allclose(late[2:], seen[:-2])


def test_a_shifted_centre_moves_torque_and_velocity():
    scenario = next(found for found in map(drawn, range(10000, 10200)) if found.motion == "mixed")
    trace, rng = simulate_trace(scenario), np.random.default_rng(0)
    steps = sample_steps(trace, PERFECT, rng)
    shifted = replace(PERFECT, cop=(0.002, -0.001))
    plain, read = (wrenches(trace, sensors, steps, rng) for sensors in (PERFECT, shifted))
    np.testing.assert_allclose(
        read[:, 3] - plain[:, 3], 0.002 * plain[:, 1] + 0.001 * plain[:, 0], atol=1e-12
    )
    plain, seen = (twists(trace, sensors, steps, rng) for sensors in (PERFECT, shifted))
    np.testing.assert_allclose(seen[:, 1] - plain[:, 1], -0.002 * plain[:, 2], atol=1e-12)
    np.testing.assert_allclose(seen[:, 0] - plain[:, 0], -0.001 * plain[:, 2], atol=1e-12)


def test_a_motion_shows_what_it_excites():
    scenarios = [drawn(seed) for seed in range(10000, 10050)]
    for motion, mu, r in (("slide", True, False), ("spin", False, False), ("mixed", True, True)):
        found = [mark for each in scenarios if each.motion == motion for mark in simulate(each).marks[-1:]]
        assert np.mean([mark.shows_mu for mark in found]) > 0.5 if mu else not any(m.shows_mu for m in found)
        assert np.mean([mark.shows_r for mark in found]) > 0.5 if r else not any(m.shows_r for m in found)


def test_an_error_that_nothing_announces_is_catastrophic():
    error = np.array([0.3, 0.3, 0.3, 0.2, 3.0])
    deviation = np.array([0.2, 0.2, 0.09, 0.01, 1.1])
    confidence = np.array([0.1, 0.6, 0.1, 0.9, 0.0])
    np.testing.assert_array_equal(misleads(error, deviation, confidence), [False, True, True, False, False])
    rows = {"estimator": "x", "quantity": "mu_c", "group": "soft", "shown": [True] * 5}
    frame = pd.DataFrame({**rows, "error": error, "deviation": deviation, "confidence": confidence})
    frame.loc[4, "shown"] = False
    found = table(frame).set_index(["quantity", "worlds"]).loc[("mu_c", "soft")]
    assert (found["marks"], found["catastrophic"], found["median"]) == (4, 50.0, pytest.approx(30.0))
    assert (found["sure"], found["sure: > 25"], found["in one sd"]) == (50.0, 50.0, 0.0)
    assert math.isnan(table(frame).set_index(["quantity", "worlds"]).loc[("r", "soft"), "median"])


def test_the_table_has_a_row_for_each_kind_of_pads():
    found = errors(10000, 10004, ("adaptive", "ukf"), progress=False)
    assert set(found["seed"]) <= set(range(10000, 10004))
    rows = table(found)
    assert len(rows) == 2 * 3 * (1 + len(GROUPS))
    every = rows[(rows["worlds"] == "all")].set_index(["estimator", "quantity"])["marks"]
    parts = rows[(rows["worlds"] != "all")].groupby(["estimator", "quantity"])["marks"].sum()
    assert every.to_dict() == parts.to_dict()
    assert every["adaptive", "mu_c"] > 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["0", "10"], "seeds 0 to 10: expected 10000 <= FIRST < LAST"),
        (["10010", "10010"], "expected 10000 <= FIRST < LAST"),
        (["10000", "10001", "--estimators", "adaptiv"], "adaptive"),
    ],
)
def test_wrong_arguments_are_a_usage_error(words, message):
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert message in done.output.replace("\n", " ")


def test_the_command_prints_the_table():
    done = CliRunner().invoke(app, ["10000", "10002"])
    assert done.exit_code == 0, done.output
    assert "| adaptive | mu_c | soft |" in done.output


def test_the_worlds_share_no_physics():
    """They import the compiler, the look-up of estimators and tables; else only themselves."""
    allowed = {"slipgym._numba.compiled", "policies.evaluation.frames", "estimator"}
    for path in Path(lab.worlds.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            own = {name for name in names if name.partition(".")[0] in ("estimator", "slipgym", "policies")}
            assert own <= allowed, path.name
