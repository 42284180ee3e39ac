"""Fingers that differ in friction, radius, centre of pressure, lag or gain, on either engine."""

import math

import numpy as np
import pytest

from slipgym.validation.bench import Bench, Friction
from slipgym.world.planar_engine import step_world
from slipgym.world.substep_length import STEADY

ENGINES = ["planar", "bullet"]
FRICTION = {"contact": {"finger_friction": [0.8, 1.2]}}
RADIUS = {"contact": {"finger_radius": [0.8, 1.2]}}
CENTRE = {"contact": {"cop_offset": [[0.002, -0.001], [-0.001, 0.002]]}}
LAG = {"gripper": {"finger_lag": [0.5, 2.0]}}
GAIN = {"gripper": {"force_gain": [0.8, 1.1]}}
ALL = {
    "contact": {"finger_friction": [1.2, 0.8], "finger_radius": [0.8, 1.1], **CENTRE["contact"]},
    "gripper": {**LAG["gripper"], **GAIN["gripper"]},
}
LONG = (0.08, 0.03, 0.5)


@pytest.mark.quick_cases(*(f"ellipsoid-overrides{k}" for k in range(6)), "distributed-overrides5")
@pytest.mark.parametrize("overrides", [FRICTION, RADIUS, CENTRE, LAG, GAIN, ALL])
@pytest.mark.parametrize("contact", ["ellipsoid", "distributed"])
def test_both_engines_agree(overrides, contact):
    """A box of eccentric mass slides and turns under a swinging grip."""
    if contact == "distributed":
        overrides = {**overrides, "contact": {"cells": 7, "radius": 0.008, **overrides.get("contact", {})}}
    traces = []
    for engine in ENGINES:
        with Bench(
            overrides, force=6.0, size=LONG, com_offset=(0.01, 0.0), contact=contact, engine=engine
        ) as bench:
            bench.settle()
            traces.append(bench.run(0.8, force=lambda t: 3.5 + 2.5 * math.cos(12.0 * t)))
    planar, bullet = traces
    assert np.linalg.norm(bullet.slip[-1, :2]) > 0.1
    assert abs(bullet.slip[-1, 2]) > 0.15
    # patches take the same sub-steps; those of a pad's steady slip may turn its friction by STEADY
    far, turned = (1e-6, 1e-5) if contact == "distributed" else STEADY**2 / 24.0 * np.abs(bullet.slip[-1, 1:])
    np.testing.assert_allclose(planar.slip[:, :2], bullet.slip[:, :2], atol=far)
    np.testing.assert_allclose(planar.slip[:, 2], bullet.slip[:, 2], atol=turned)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("overrides", "direction", "limit"),
    [
        (FRICTION, (1.0, 0.0, 0.0), 1.0),
        (FRICTION, (0.0, 0.0, 0.01), 1.0),
        (RADIUS, (0.0, 0.0, 0.01), 1.0),
        ({"contact": {"finger_friction": [0.8, 1.2], "finger_radius": [0.8, 1.2]}}, (0.0, 0.0, 0.01), 1.04),
        (GAIN, (1.0, 0.0, 0.0), 0.95),
    ],
)
def test_break_away_is_at_the_sum_of_both_limits(engine, overrides, direction, limit):
    """Along x and about the grip axis; over 2 mu_s f_n and 2 mu_s f_n r of equal fingers."""
    force, friction = 5.0, Friction(mu_s=0.5, mu_c=0.4)
    values = {**overrides, "physics": {"gravity": 0.0}}
    with Bench(values, friction, force=force, engine=engine) as bench:
        bench.settle()
        top = 2.0 * friction.mu_s * force
        trace = bench.run(
            1.5,
            load=lambda t: (0.8 + 0.2 * t) * top * np.array(direction),
            until=lambda b: np.abs(b.plant.world["slip"][0] * [1.0, 1.0, friction.r]).max() > 5e-6,
        )
    reached = np.abs(trace.load[-1]).max() / (top * max(direction))
    assert reached == pytest.approx(limit, rel=0.01)


@pytest.mark.parametrize("engine", ENGINES)
def test_both_pads_press_with_the_mean_of_both_actuators(engine):
    lags, gains, start, end = (0.006, 0.024), (0.8, 1.1), 5.0, 12.0
    with Bench({"gripper": {**LAG["gripper"], **GAIN["gripper"]}}, force=start, engine=engine) as bench:
        gripper, h = bench.config.gripper, bench.engine_time
        bench.settle()
        trace = bench.run(0.15, force=lambda _: end)
        measured = bench.plant.force_torque["history"][0, :, :, 2].max(axis=1)
        t = bench.step_time * np.arange(1, len(trace.time) + 1)

    def response(time):
        since = np.maximum(time - gripper.dead_time, 0.0)
        return np.stack(
            [g * (end + (start - end) * np.exp(-since / lag)) for g, lag in zip(gains, lags, strict=True)], 1
        )

    np.testing.assert_allclose(trace.force, response(t), rtol=1e-9)
    span = np.linspace(0.0, h, 101) if engine == "bullet" else [0.0]
    mean = np.mean([response(t - shift).mean(axis=1) for shift in span], axis=0)
    np.testing.assert_allclose(trace.normal, np.tile(mean[:, None], 2), rtol=5e-3)
    np.testing.assert_allclose(trace.normal[:, 0], trace.normal[:, 1], rtol=1e-5)
    np.testing.assert_allclose(measured, 0.95 * end, rtol=5e-3)  # so do both sensors


def test_unequal_gains_do_not_push_the_object_along_the_grip_axis():
    with Bench(GAIN, force=20.0) as bench:
        bench.settle()
        bench.run(1.0, force=lambda t: 15.0 + 5.0 * math.sin(20.0 * t))
        assert bench.world.reading[0][0][1] == pytest.approx(0.0, abs=1e-6)
        assert bench.world.reading[4][3:] == pytest.approx([0.0, 0.0], abs=1e-5)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_gain_ends_at_the_hard_limit(engine):
    with Bench({"gripper": {"force_gain": [0.5, 2.0]}}, engine=engine) as bench:
        trace = bench.run(0.4, force=lambda _: 30.0)
        small = bench.run(0.4, force=lambda _: 0.45)  # below open_below, whatever the gain
    np.testing.assert_allclose(trace.force[-1], [15.0, 40.0], rtol=1e-6)
    np.testing.assert_allclose(trace.normal[-1], 27.5, rtol=1e-4)
    np.testing.assert_allclose(small.force[-1], 0.0, atol=1e-6)


@pytest.mark.parametrize("overrides", [{}, FRICTION, RADIUS, CENTRE, LAG, GAIN, ALL])
def test_a_firm_hold_takes_long_sub_steps_whichever_way_fingers_differ(overrides):
    with Bench(overrides, force=15.0, engine="planar", com_offset=(0.01, 0.0)) as bench:
        bench.settle()
        plant = bench.plant
        arrays = plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors
        steps = [step_world(*arrays, 15.0, 0) for _ in range(10)]
    assert max(steps) <= 2
