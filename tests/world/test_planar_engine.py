"""The planar world without an engine: what its sub-steps keep exact."""

import math

import gymnasium as gym
import numpy as np
import pytest

import policies
from lab.validation.slides import slides
from slipgym.config import load
from slipgym.sensors.measure import measure
from slipgym.validation.bench import Bench, Friction
from slipgym.world.placing import place
from slipgym.world.planar_engine import step_world
from slipgym.world.plant import build
from slipgym.world.scene import Box
from slipgym.world.substep_length import STILL


def test_a_slide_under_a_closing_grip_is_exact():
    """One control step in few sub-steps, against the integrals of the force loop.

    Friction 2 mu_c N(t) opposes the fall; N = 6 - 3 exp(-t / lag).
    """
    plant = build(load({"contact": {"sigma_2": 0.0}, "gripper": {"dead_time": 0.0}}))
    world, pads, fingers = plant.world[0], plant.pads[0], plant.fingers[0]
    start, mass, mu = -0.5, 0.2, 0.4
    world["mass"], world["inertia"] = mass, 1e-4
    world["velocity"][1] = start
    for pad in pads:
        pad["mu_c"], pad["mu_s"], pad["slip_speed"], pad["slip_rate"] = mu, 0.5, -start, 1.0
        pad["z"][1] = -mu / pad["sigma_0"]
        pad["wrench"][1] = 3.0 * mu
    fingers["force"] = fingers["command"] = fingers["contact_force"] = 3.0
    lag, t = fingers["lag"][0], (world["control_ticks"] * world["tick_length"]).item()
    done = step_world(
        plant.world, plant.pads, None, plant.fingers, plant.force_torque, plant.slip_sensors, 6.0, 0
    )
    left = math.exp(-t / lag)
    impulse = 6.0 * t - 3.0 * lag * (1.0 - left)
    double = 3.0 * t**2 - 3.0 * lag * (t - lag * (1.0 - left))
    gravity = world["gravity"].item()
    assert done <= 8
    assert world["velocity"][1] == pytest.approx(start - gravity * t + 2 * mu * impulse / mass, abs=1e-9)
    assert world["com"][1] == pytest.approx(
        start * t - 0.5 * gravity * t**2 + 2 * mu * double / mass, abs=1e-9
    )
    assert world["relative_velocity"][1] == pytest.approx(world["velocity"][1], abs=1e-12)
    assert pads["normal"] == pytest.approx(6.0 - 3.0 * left, rel=1e-12)
    assert pads["wrench"][:, 1] == pytest.approx(mu * pads["normal"], rel=1e-9)


def test_a_poke_breaks_a_firm_hold_away_as_on_pybullet():
    """Within what a break-away late by half a friction sub-step would be worth.

    The planar engine stands in a sub-step of 8 ms when the poke comes.
    """
    poke, begin, end = (4.0, -3.0, 0.02), 0.05, 0.07
    ends = []
    for engine in ("bullet", "planar"):
        with Bench(force=5.0, engine=engine) as bench:
            bench.settle()
            trace = bench.run(0.2, load=lambda t: poke if begin <= t < end else (0.0, 0.0, 0.0))
            ends.append(trace.slip[-1, :2])
            speed = 0.5 * bench.config.physics.substep_max * np.linalg.norm(poke[:2]) / bench.box.mass
    assert np.linalg.norm(ends[0]) > 5e-3
    np.testing.assert_allclose(*ends, atol=speed * (end - begin))


def test_a_long_box_rocks_in_its_bristles_as_on_pybullet():
    """The wrist begins to turn: for a fifth of a second the box swings, with a sixth of what breaks it away.

    A vibration below STILL of the limit may be damped.
    """
    ends = []
    for engine in ("bullet", "planar"):
        with Bench(force=3.0, engine=engine, size=(0.08, 0.03, 0.4)) as bench:
            bench.settle()
            ends.append(bench.run(0.3, wrist=lambda t: (0.0, 0.0, 0.01 if t > 0.02 else 0.0)).slip[:, 2])
            limit = bench.friction.mu_s / (bench.config.contact.sigma_0 * bench.friction.r)
    assert np.abs(ends[0]).max() > 0.15 * limit
    np.testing.assert_allclose(*ends, atol=STILL * limit)


def test_a_slide_under_a_closing_grip_has_the_exact_momentum():
    """Against the integral of the force loop's first-order lag, at mu_s = mu_c and without viscosity."""
    mu, low, high, mass = 0.4, 1.0, 2.0, 0.2
    overrides = {"contact": {"sigma_2": 0.0}, "gripper": {"dead_time": 0.0}}
    friction = Friction(mu_s=mu, mu_c=mu)
    with Bench(overrides, friction, force=low, mass=mass, engine="planar", size=(0.08, 0.03, 0.4)) as bench:
        gravity, lag = bench.config.physics.gravity, bench.config.gripper.lag
        before = bench.run(0.1).velocity[-1, 1]
        trace = bench.run(0.1, force=lambda _: high)
    t = trace.time - 0.1
    impulse = high * t + (low - high) * lag * (1.0 - np.exp(-t / lag))
    expected = before - gravity * t + 2.0 * mu * impulse / mass
    np.testing.assert_allclose(trace.velocity[:, 1], expected, rtol=1e-9)


@pytest.mark.parametrize(("engine", "exact"), [("bullet", 5e-7), ("planar", 1e-12)])
def test_a_slide_under_a_constant_grip_is_a_parabola(engine, exact):
    """At mu_s = mu_c and without viscosity; one that is half a sub-step ahead of itself is 0.14 mm off.

    PyBullet's normal force is the actuator's to some 1e-6.
    """
    mu, force, mass = 0.4, 1.0, 0.2
    overrides = {"contact": {"sigma_2": 0.0}}
    friction = Friction(mu_s=mu, mu_c=mu)
    with Bench(overrides, friction, force=force, mass=mass, engine=engine, size=(0.08, 0.03, 0.4)) as bench:
        acceleration = bench.config.physics.gravity - 2.0 * mu * force / mass
        start = bench.run(0.1)
        speed = -start.velocity[-1, 1] + acceleration * bench.velocity_age
        trace = bench.run(0.1)
    t = trace.time - start.time[-1]
    expected = start.position[-1, 1] - speed * t - 0.5 * acceleration * t**2
    np.testing.assert_allclose(trace.position[:, 1], expected, atol=exact)


def test_a_long_sub_step_holds_what_a_short_one_holds():
    """A wrist that jerks at 80 % of the limit: both stay within the bristles' reach and end alike."""
    ends = []
    for longest in (2e-3, 2.5e-4):
        with Bench({"physics": {"planar_substep_max": longest}}, force=2.4, engine="planar") as bench:
            bench.settle()
            pulse = bench.run(0.5, wrist=lambda t: (0.002 * math.sin(40.0 * t), 0.0, 0.0))
            ends.append(pulse.slip[-1])
            assert np.abs(pulse.slip[:, :2]).max() < bench.friction.mu_s / bench.config.contact.sigma_0
    np.testing.assert_allclose(*ends, atol=1e-8)


@pytest.mark.parametrize("model", ["ellipsoid", "distributed"])
def test_alike_pads_are_solved_as_one(model):
    """Against pads whose centres of pressure lie a picometre apart, which are solved as two."""
    found = []
    for apart in (0.0, 1e-12):
        overrides = {"contact": {"cells": 7, "cop_offset": [[0.0, 0.0], [apart, 0.0]]}}
        box = {"force": 5.0, "com_offset": (0.01, 0.0)}
        with Bench(overrides, contact=model, engine="planar", **box) as bench:
            bench.settle()
            trace = bench.run(0.4, force=lambda t: 1.5 + math.cos(40.0 * t))
            plant = bench.plant
            found.append([trace.slip, plant.pads["wrench"], plant.pads["z"], plant.fingers["force"]])
            found[-1] += [plant.force_torque["history"][..., :5], plant.slip_sensors["measured_slip"]]
            assert np.abs(trace.slip[-1]).min() > 1e-3
    for one, two in zip(*found, strict=True):
        np.testing.assert_allclose(one, two, rtol=1e-6, atol=1e-9)
    for array in found[0][1:4]:
        np.testing.assert_array_equal(array[0, 0], array[0, 1])


def test_slides_of_both_engines_agree():
    figures = list(slides(5))
    assert len(figures) == 4
    assert [figure for figure in figures if not figure.ok] == []


@pytest.mark.parametrize("period", [10, 97, 99])
@pytest.mark.parametrize("pitching", [False, True])
def test_friction_carries_the_object_however_uneven_sub_steps_are(period, pitching):
    """A firm grip on a wrist with constant acceleration: friction is weight and inertia, also after one tick.

    The pads' own vibration decays within a few of the implicit sub-steps.
    """
    config = load()
    plant, acceleration = build(config), np.array([1.0, -0.5, 3.0 if pitching else 0.0])
    box = Box((0.08, 0.03, 0.16), (0.02, -0.01), (0.0, 0.0), 0.2, 1e-3)
    plant.pads["mu_s"], plant.pads["mu_c"] = 0.6, 0.4
    plant.force_torque["period"] = period  # a sub-step ends with the last sample of a control step
    place(plant, 0, box, 20.0, (0.0, 0.0, 0.0))
    wrenches, twists = np.zeros((1, 2, 4)), np.zeros((1, 2, 3))
    for _ in range(12):
        plant.world["wrist_acceleration"][0] = acceleration
        bodies = plant.world, plant.pads, None, plant.fingers, plant.force_torque, plant.slip_sensors
        step_world(*bodies, 20.0, 0)
        measure(plant.world, plant.force_torque, plant.slip_sensors, wrenches, twists)
    world = plant.world[0]
    cos, sin = math.cos(world["wrist"][2]), math.sin(world["wrist"][2])
    x, z = world["com"] - world["wrist"][:2]
    omega, alpha = world["wrist_velocity"][2], acceleration[2]
    a = acceleration[:2] + np.array([-alpha * z - omega**2 * x, alpha * x - omega**2 * z])
    force = box.mass * (a + np.array([0.0, config.physics.gravity]))
    torque = box.inertia * alpha + x * force[1] - z * force[0]  # about the pads' centre
    pushed = cos * force[0] + sin * force[1], cos * force[1] - sin * force[0], torque
    # half a sub-step of 8 ms lies between the accelerations of both ends: 0.4 % where the wrist pitches
    np.testing.assert_allclose(plant.pads["wrench"][0].sum(axis=0), pushed, rtol=1e-2)


def test_a_shaken_box_is_held_as_on_pybullet():
    """Light and gripped hard, with commands that fall due at any moment."""
    found = []
    for engine in ("bullet", "planar"):
        env = gym.make(
            "slipgym:slipgym/Hold-v0", engine=engine, friction_source="true", randomization="train"
        )
        policy, state = policies.make("hold"), None
        observation, _ = env.reset(seed=35)
        total, over, loads = 0.0, False, []
        while not over:
            action, state = policy.predict(observation, state=state)
            observation, reward, terminated, truncated, info = env.step(action)
            total, over = total + reward, terminated or truncated
            loads.append(np.abs(info["contact_wrench"][:, :2]).max())
        env.close()
        found.append((total, max(loads), info["is_success"]))
    assert [success for *_, success in found] == [True, True]
    assert found[1][0] == pytest.approx(found[0][0], rel=0.03)
    assert found[1][1] < 1.5 * found[0][1]
