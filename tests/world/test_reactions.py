"""What the object gains the gripper loses."""

from functools import cache

import numpy as np
import pybullet
import pytest

from lab.validation.agreement import shake
from slipgym.validation.bench import Bench
from slipgym.world.bullet_engine import BulletWorld
from slipgym.world.scene import FINGER_LINKS, WRIST_JOINTS


def record_loads(monkeypatch) -> list:
    """Note (load on the object, reaction on finger 1, on finger 2) of every engine step of later worlds."""
    loads, rows = [], BulletWorld.rows.func

    def watched(world):
        functions = rows(world)
        original = functions.loads

        def recorded(*arguments):
            answer = original(*arguments)
            loads.append(answer[:3])
            return answer

        functions.loads = recorded
        return functions

    monkeypatch.setattr(BulletWorld, "rows", property(cache(watched)))
    return loads


@pytest.mark.parametrize(("grip", "wrist"), [(10.0, None), (1.85, None), (2.5, shake)])
def test_friction_and_its_reactions_cancel(monkeypatch, grip, wrist):
    loads = record_loads(monkeypatch)
    external = np.array([0.3, -0.2, 0.004])
    cop = {"cop_offset": [[0.002, 0.001], [-0.001, 0.002]]}
    with Bench({"contact": cop}, com_offset=(0.005, -0.01)) as bench:
        bench.settle()
        loads.clear()
        bench.run(0.2, force=lambda _: grip, load=lambda _: external, wrist=wrist)
    assert len(loads) == 24 * bench.config.physics.engine_steps
    for (force, _), *reactions in loads:
        # the engine adds the weight itself: it is no part of the load
        friction = np.array(force) - (external[0], 0.0, external[1])
        total = friction + sum(np.array(reaction[1]) for reaction in reactions)
        # rounding of m (velocity change) / dt, of terms of some 100 N
        np.testing.assert_allclose(total, 0.0, atol=1e-10)


def test_torques_cancel_about_any_point(monkeypatch):
    loads = record_loads(monkeypatch)
    with Bench({"physics": {"gravity": 0.0}}, com_offset=(0.005, -0.01), force=5.0) as bench:
        bench.settle()
        for push in ((3.0, -2.0, 0.05), (9.0, 5.0, -0.2), (0.0, 0.0, 0.3)):
            for _ in range(5):
                loads.clear()
                # the engine applies the last load where the object was before its last step
                before = bench.world.reading[0][0]
                bench.run(bench.step_time, load=lambda _, push=push: push)
                force, torque = loads[0][0]
                total = np.cross(before, force) + torque
                total -= (0.0, -push[2], 0.0)
                total -= np.cross(before, (push[0], 0.0, push[1]))
                for point, reaction_force, reaction_torque in loads[0][1:]:
                    total += np.cross(point, reaction_force) + reaction_torque
                np.testing.assert_allclose(total[1], 0.0, atol=1e-11)


@pytest.mark.parametrize(("grip", "sliding"), [(10.0, False), (2.0, True)])
def test_the_wrist_motor_carries_what_friction_carries(grip, sliding):
    with Bench(force=10.0) as bench:
        bench.settle()
        if sliding:
            bench.run(0.05, force=lambda _: 1.5)
        bench.run(0.1, force=lambda _: grip)
        start = bench.world.reading[1][0][2]
        trace = bench.run(bench.step_time, force=lambda _: grip)
        client, gripper = bench.world.client, bench.world.gripper
        effort = pybullet.getJointState(gripper, WRIST_JOINTS[1], physicsClientId=client)[3]
        gravity, mass = bench.config.physics.gravity, bench.box.mass
        acceleration = (trace.velocity[0, 1] - start) / bench.step_time
        links = (*WRIST_JOINTS[1:], *FINGER_LINKS)
        carried = sum(pybullet.getDynamicsInfo(gripper, link, physicsClientId=client)[0] for link in links)
    assert sliding == (abs(start) > 0.01)
    # the motor's effort is that of one engine step, friction the mean over four: 1 % while it changes
    friction = mass * (gravity + acceleration)
    assert effort - gravity * carried == pytest.approx(friction, rel=1e-2 if sliding else 1e-6)


@pytest.mark.parametrize("mass", [0.02, 0.05, 0.2])
def test_pads_press_with_what_the_actuators_give(mass):
    """Grip and wrist move. An iteration of the solver goes from one pad to the other through the box."""
    found, given = [], []
    with Bench({"object": {"mass": mass}}, force=5.0) as bench:
        bench.settle()
        for k in range(60):
            grip, speed = 5.0 + 3.0 * np.sin(0.5 * k), (0.05 * np.sin(0.25 * k), 0.0, 0.5 * np.sin(0.2 * k))
            bench.run(bench.step_time, force=lambda _, grip=grip: grip, wrist=lambda _, speed=speed: speed)
            found.append(bench.world.reading[3])
            given.append(bench.plant.fingers["mean_force"][0].copy())
        finger, iterations = bench.config.gripper.finger_mass, bench.config.physics.solver_iterations
    left = (finger / (finger + mass)) ** (2 * iterations)
    np.testing.assert_allclose(found, given, rtol=left + 1e-8)  # 1e-8: a drift along the grip axis is damped


def test_normal_forces_are_the_sums_of_the_contact_points():
    """They are read off the fingers' momentum. Grip, wrist and load change at every step; then it lets go."""
    with Bench(force=5.0) as bench:
        bench.settle()
        world = bench.world
        for k in range(60):
            grip = 5.0 + 4.0 * np.sin(0.5 * k) if k < 40 else 0.0
            wrist = (0.05 * np.sin(0.25 * k), 0.0, 0.5 * np.sin(0.2 * k))
            push = (0.3 * np.sin(0.1 * k), 0.2, 0.01)
            steps = {"force": grip, "wrist": wrist, "load": push}
            bench.run(bench.step_time, **{name: lambda _, x=x: x for name, x in steps.items()})
            points = pybullet.getContactPoints(world.body, world.gripper, physicsClientId=world.client)
            sums = [sum(point[9] for point in points if point[4] == link) for link in FINGER_LINKS]
            # rounding of m (speed change) / dt; less than 1e-9 N counts as nothing
            np.testing.assert_allclose(world.reading[3], sums, rtol=1e-12, atol=1e-9)


def test_flat_pads_do_not_let_the_box_tilt():
    """Pads of different centres of pressure pull at different heights, half the thickness off the middle."""
    with Bench({"contact": {"cop_offset": [[0.002, 0.001], [-0.001, 0.002]]}}, force=5.0) as bench:
        bench.settle()
        for k in range(40):
            bench.run(bench.step_time, wrist=lambda _, k=k: (0.05 * np.sin(0.25 * k), 0.0, 0.5))
            (x, _, z, _), spin = bench.world.reading[0][1], bench.world.reading[1][1]
            assert (x, z, spin[0], spin[2]) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("factor", [1.0, 3.0, 0.5])
def test_a_box_turns_with_its_inertia_from_the_first_step_on(factor):
    with Bench({"physics": {"gravity": 0.0}}, force=5.0) as bench:
        world, plant = bench.world, bench.plant
        inertia = factor * bench.box.inertia
        plant.world["mass"], plant.world["inertia"] = factor * bench.box.mass, inertia
        world.update_mass(world._plant.world["mass"].item())
        before = np.array(world.reading[1][1])
        pybullet.applyExternalTorque(world.body, -1, (0.0, 0.01, 0.0), pybullet.WORLD_FRAME, world.client)
        pybullet.stepSimulation(world.client)
        after = np.array(pybullet.getBaseVelocity(world.body, world.client)[1])
        dt = 1.0 / bench.config.physics.engine_rate
        np.testing.assert_allclose(after - before, (0.0, 0.01 * dt / inertia, 0.0), rtol=1e-9, atol=1e-12)
