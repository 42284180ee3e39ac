"""With physics.tilt the pads' pressure, the jaws and the free body move the object out of the contact plane.

Static balance, oscillation, free fall and free rotation are figures of `lab.validation.tilt`.
"""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.spatial.transform import Rotation

from lab.validation.tilt import SPIN, roll_over, thrown, tilting
from lab.validation.tilt_oracle import free_attitude, pressed
from slipgym.config import load
from slipgym.contact.foundation import compressed_part, press
from slipgym.world.plant import build
from slipgym.world.wrist import ramp_tilt

G, RADIUS, STIFFNESS = 9.81, 0.015, 1e5


@pytest.mark.parametrize("a", [-0.99, -0.4, 0.0, 0.3, 0.95])
def test_integrals_over_a_part_of_the_disc(a):
    def integral(weight):
        return quad(lambda x: weight(x, math.sqrt(1.0 - x * x)), -a, 1.0, epsabs=1e-12)[0]

    chord = [
        lambda x, y: 2 * y,
        lambda x, y: 2 * x * y,
        lambda x, y: 2 * x * x * y,
        lambda x, y: 2 * y**3 / 3,
    ]
    np.testing.assert_allclose(
        compressed_part(a), [integral(weight) for weight in chord], rtol=1e-9, atol=1e-12
    )


@pytest.mark.parametrize("depth", [-1.2e-4, -1e-4, -3e-5, 0.0, 8e-5, 1.5e-4, 4e-4])
def test_a_pressed_disc_against_quadrature(depth):
    """The edge lifts off at a depth of 1.5e-4 m; the slope's direction is oblique."""
    slope, direction = 0.01, np.array([0.6, -0.8])
    force, *moment = press(depth, tuple(slope * direction), (0.0, 0.0, 0.0), RADIUS, 0.0)
    expected = pressed(depth, slope, STIFFNESS, RADIUS)
    np.testing.assert_allclose(STIFFNESS * force, expected[0], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(STIFFNESS * np.array(moment), expected[1] * direction, rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("depth", [3e-5, 1.49e-4, 1.51e-4])
def test_damping_is_that_of_dampers_beside_the_springs(depth):
    """A short way at these rates changes the springs' force by the way over the relaxation time."""
    slope, rates, time = np.array([0.008, 0.006]), np.array([2e-3, 0.4, -0.7]), 1e-6
    there = press(depth + time * rates[0], tuple(slope + time * rates[1:]), (0.0,) * 3, RADIUS, 0.0)
    here = press(depth, tuple(slope), (0.0,) * 3, RADIUS, 0.0)
    damped = press(depth, tuple(slope), tuple(rates), RADIUS, 1e-3)
    expected = 1e-3 * np.subtract(there, here) / time
    np.testing.assert_allclose(np.subtract(damped, here)[0], expected[0], rtol=1e-3)
    if depth > 1.5e-4:
        np.testing.assert_allclose(np.subtract(damped, here), expected, rtol=1e-6)


def test_a_pad_does_not_pull():
    assert press(1e-5, (0.0, 0.0), (-1.0, 0.0, 0.0), RADIUS, 1e-3) == (0.0, 0.0, 0.0)
    assert press(1e-5, (0.01, 0.0), (-1.0, 0.0, 0.0), RADIUS, 1e-3) == (0.0, 0.0, 0.0)


def stored(tilt, arm) -> float:
    """Energy of the springs of both pads, by a sum over small squares [J]."""
    edge = np.linspace(-RADIUS, RADIUS, 601)
    x, z = np.meshgrid(0.5 * (edge[1:] + edge[:-1]), 0.5 * (edge[1:] + edge[:-1]))
    inside = x**2 + z**2 < RADIUS**2
    normal = Rotation.from_quat(tilt["attitude"]).apply([0.0, 1.0, 0.0])
    face = tilt["height"] - normal[0] * (x + arm[0]) - normal[2] * (z + arm[1])
    total = sum(np.mean(np.maximum(0.0, tilt["closure"] + side * face)[inside] ** 2) for side in (1.0, -1.0))
    return 0.5 * STIFFNESS * float(total)


def energy(bench) -> float:
    """Energy of springs, object and jaws, less the actuators' work [J]."""
    tilt, world = bench.plant.tilt[0], bench.plant.world[0]
    spin = 0.5 * float(tilt["momentum"] @ tilt["spin"]) + 0.5 * bench.box.mass * float(tilt["speed"]) ** 2
    spin += 0.5 * bench.box.mass * float(world["velocity"][:2] @ world["velocity"][:2])
    jaws = 0.5 * float(tilt["jaw_mass"] * tilt["closing"] ** 2) - 2.0 * 4.0 * float(tilt["closure"])
    return spin + jaws + stored(tilt, world["wrist"][:2] - world["com"])


@pytest.mark.parametrize("damping", [0.0, 30.0])
def test_an_object_that_rattles_between_the_pads_gains_no_energy(damping):
    """Edges of the pads lift off and land again; friction has nothing to do."""
    pads = {"normal_damping": damping, "normal_stiffness": STIFFNESS}
    with tilting({"contact": pads, "physics": {"gravity": 0.0}}, force=4.0, com_offset=(0.0, 0.01)) as bench:
        tilt = bench.plant.tilt[0]
        tilt["jaw_damping"] = 0.0
        tilt["momentum"], tilt["speed"] = (1.2e-3, 0.0, 4e-4), 0.05
        tilt["spin"] = tilt["momentum"] / (bench.box.mass * tilt["gyration"])
        least, energies = math.inf, [energy(bench)]
        for _ in range(120):
            bench.run(bench.step_time)
            energies.append(energy(bench))
            least = min(least, *(tilt["closure"] - RADIUS * np.hypot(*tilt["attitude"][[0, 2]]) * 2.0,))
    swing = energies[0] + 4.0 * 4.0 / STIFFNESS  # above the energy of rest
    assert least < 0.0
    if damping == 0.0:
        np.testing.assert_allclose(energies, energies[0], atol=0.01 * swing)
    else:
        assert np.all(np.diff(energies) < 1e-3 * swing)
        assert energies[-1] < energies[0] - 0.5 * swing


@pytest.mark.parametrize(
    ("mass", "stiffness", "damping"), [(0.02, 1e6, 0.0), (0.02, 1e6, 1e3), (1.0, 1e4, 10.0)]
)
def test_light_and_stiff_bodies_come_to_rest(mass, stiffness, damping):
    pads = {"normal_stiffness": stiffness, "normal_damping": damping}
    with tilting({"contact": pads}, force=8.0, mass=mass, com_offset=(0.004, -0.01)) as bench:
        roll_over(bench, 0.4)
        half = 0.5 * mass * G * math.sin(0.4)
        rtol = {0.0: 0.05, 1e3: 1e-6, 10.0: 5e-3}[damping]
        np.testing.assert_allclose(bench.plant.tilt["normal"][0], (8.0 - half, 8.0 + half), rtol=rtol)


def test_the_wrist_carries_the_object_along_the_grip_axis():
    with tilting(force=5.0) as bench:
        bench.settle()
        for k in range(40):
            ramp_tilt(bench.plant.tilt[0], 0.0, 2.0 * (k + 1) * bench.step_time, 1.0, 5.0, bench.step_time)
            bench.run(bench.step_time)
        assert bench.plant.tilt["sway"][0, 1] == pytest.approx(2.0 * 40 * bench.step_time)
        half = 0.5 * bench.box.mass * 2.0
        # the finger behind pushes
        np.testing.assert_allclose(bench.plant.tilt["normal"][0], (5.0 - half, 5.0 + half), rtol=1e-3)


def test_a_weight_beyond_the_grip_pushes_the_jaws_open():
    force = 0.55
    with tilting(force=force, roll=0.5 * math.pi, mass=0.3) as bench:
        start = bench.world.reading[0][0][1]
        bench.run(0.3)
        tilt, mass = bench.plant.tilt[0], bench.box.mass
        moved = float(tilt["jaw_mass"]) + mass

        def rate(_, state):
            return state[1], (2.0 * force - mass * G - float(tilt["jaw_damping"]) * state[1]) / moved

        fallen = solve_ivp(rate, (0.0, 0.3), (0.0, 0.0), rtol=1e-9).y[0, -1]
        assert bench.world.reading[0][0][1] - start == pytest.approx(fallen, rel=0.01)
        assert tilt["normal"][0] == 0.0


def test_the_centre_of_pressure_moves_with_the_moment():
    with tilting(force=5.0, com_offset=(0.006, -0.008)) as bench:
        roll_over(bench, 0.8)
        tilt, pads = bench.plant.tilt[0], bench.plant.pads[0]
        weight = bench.box.mass * G * math.sin(0.8)
        x, z = bench.plant.world["wrist"][0, :2] - bench.plant.world["com"][0]
        friction = bench.plant.fingers["reaction"][0]
        half = bench.box.size[1] / 2
        about_x = -z * weight + half * (friction[0, 1] - friction[1, 1])
        about_z = x * weight - half * (friction[0, 0] - friction[1, 0])
        each = np.array([about_z, -about_x]) / 2  # the moment of either pad's pressure
        for f, side in enumerate((1.0, -1.0)):
            np.testing.assert_allclose(pads["cop"][f], side * each / tilt["normal"][f], rtol=0.01)
        sensor = bench.plant.force_torque[0, 0]
        newest = (bench.plant.world["tick"][0] // sensor["period"]) % sensor["kept"]
        np.testing.assert_allclose(sensor["history"][newest, 3:5], (each[1], -each[0]), rtol=0.01)


def test_a_centre_of_pressure_beside_the_pads_centre_tilts():
    """Both pads press at their own points: their forces are a couple."""
    cop = [[0.002, 0.0], [-0.001, 0.003]]
    with tilting({"contact": {"cop_offset": cop}, "physics": {"gravity": 0.0}}, force=5.0) as bench:
        bench.run(0.5)
        rotation = Rotation.from_quat(bench.plant.tilt["attitude"][0]).as_rotvec()
    lever = np.subtract(*cop)
    slope = 5.0 * lever / (2.0 * STIFFNESS * RADIUS**2 / 4.0)
    np.testing.assert_allclose((rotation[2], -rotation[0]), -slope, rtol=0.01)


def test_a_body_thrown_in_a_rolling_frame_turns_freely_in_space():
    with thrown() as bench:
        tilt = bench.plant.tilt[0]
        principal = bench.box.mass * tilt["gyration"].copy()
        tilt["roll"][1] = 1.5
        tilt["momentum"] = principal * SPIN
        for _ in range(60):
            bench.run(bench.step_time)
        found = Rotation.from_rotvec([1.5 * 0.5, 0.0, 0.0]) * Rotation.from_quat(tilt["attitude"])
    expected = free_attitude(principal, SPIN, np.array([0.25, 0.5]))[-1]
    assert (found * expected.inv()).magnitude() < 1e-3 * 0.5 * np.linalg.norm(SPIN)


def test_an_upright_grip_moves_as_without_tilt():
    def motion(tilt):
        with tilting({"physics": {"tilt": tilt}}, force=3.0) as bench:
            bench.plant.pads["mu_s"], bench.plant.pads["mu_c"] = 0.45, 0.4
            trace = bench.run(0.7, force=lambda t: 3.0 - 1.0 * math.sin(2.0 * t))
        return trace.slip[-1]

    there, here = motion(True), motion(False)
    assert np.linalg.norm(here[:2]) > 5e-4
    np.testing.assert_allclose(there, here, rtol=2e-3, atol=1e-9)


def test_without_tilt_there_is_no_such_state():
    assert build(load()).tilt is None


def test_friction_holds_an_oblique_object_in_a_rolling_wrist():
    """A box whose axes are oblique to the roll's axis has a product of inertia: it turns in the grip."""
    rate, angle = 5.0, 0.6
    with tilting({"physics": {"gravity": 0.0}}, force=10.0, wrist=(0.0, 0.0, angle)) as bench:
        for k in range(120):
            speed = rate * min(1.0, (k + 1) / 60)
            ramp_tilt(bench.plant.tilt[0], speed, 0.0, 10.0, 1.0, bench.step_time)
            bench.run(bench.step_time)
        a, _, b = bench.box.mass * bench.plant.tilt["gyration"][0]
        product = (a - b) * math.sin(angle) * math.cos(angle)
        torque = bench.plant.pads["wrench"][0, :, 2].sum()
    assert torque == pytest.approx(rate**2 * product, rel=0.01)
