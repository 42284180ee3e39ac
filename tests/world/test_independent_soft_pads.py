"""Each law of a soft pad against an independent formulation: closed forms, or scipy on the equations."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lab.benchmarking.measure import SOFT_PADS
from slipgym.contact import DiscContact, DistributedContact, EllipsoidContact
from slipgym.validation.bench import Bench, Friction

MU_S, MU_C, R, MASS = 0.6, 0.4, 0.008, 0.2
FRICTION = Friction(mu_s=MU_S, mu_c=MU_C, r=R)
ENGINES = ["planar", "bullet"]
SIZE = (0.4, 0.03, 0.8)


def bench(pad: dict, engine: str, contact: str = "ellipsoid", gravity: float = 0.0, **options) -> Bench:
    """A bench without gravity whose pads have some parameters."""
    overrides = {"physics": {"gravity": gravity}, "contact": {"pad": pad, "sigma_2": 0.0}}
    options = {"friction": FRICTION, "mass": MASS, "size": SIZE, **options}
    return Bench(overrides, engine=engine, contact=contact, **options)


def drag(held: Bench, load: tuple[float, float, float], duration: float = 0.1) -> np.ndarray:
    """Friction on the object at the end of a slide under a load, both pads (f_x, f_y, tau)."""
    held.run(duration, load=lambda _: load)
    assert np.linalg.norm(held.plant.world["slip"][0] * (1.0, 1.0, R)) > 1e-3
    return held.plant.pads["wrench"][0].sum(axis=0)


@pytest.mark.quick_cases(
    *("0.31-1.0-ellipsoid-planar", "-0.4-12.0-ellipsoid-bullet", "0.31-12.0-disc-planar"),
    *("-0.4-1.0-disc-planar", "0.31-3.0-distributed-planar", "-0.4-12.0-distributed-planar"),
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("contact", ["ellipsoid", "disc", "distributed"])
@pytest.mark.parametrize("force", [1.0, 3.0, 12.0])
@pytest.mark.parametrize("exponent", [0.31, -0.4])
def test_friction_falls_or_rises_with_the_load(exponent, force, contact, engine):
    with bench({"load_exponent": exponent}, engine, contact, force=force) as held:
        held.settle()
        scale = (force / 5.0) ** -exponent
        # in 0.1 s the heaviest load would push the box out of the grip
        friction = drag(held, (1.3 * MU_S * scale * 2.0 * force, 0.0, 0.0), 0.05)
    assert -friction[0] == pytest.approx(2.0 * MU_C * scale * force, rel=0.01)


@pytest.mark.parametrize("kind", [EllipsoidContact, DiscContact, DistributedContact])
@pytest.mark.parametrize("exponent", [0.5, -0.4])
def test_friction_follows_a_load_that_changes(exponent, kind):
    """Up and down over four decades in steps within the kernel's expansion, then in one beyond it."""
    contact = kind(mu_s=MU_S, mu_c=MU_C, sigma_1=0.0, sigma_2=0.0)
    contact._pads["load_exponent"], contact._pads["reference_force"] = exponent, 5.0
    rising = np.geomspace(1e-2, 100.0, 2000)
    contact.step((0.05, 0.0, 0.0), rising[0], 0.1)  # from rest into slip
    for force in (*rising, *rising[::-1], 40.0):
        friction = contact.step((0.05, 0.0, 0.0), force, 1e-3)
        assert -friction[0] == pytest.approx(MU_C * force * (force / 5.0) ** -exponent, rel=1e-5)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("force", [pytest.param(1.0, marks=pytest.mark.slow), 5.0, 12.0])
def test_the_contact_grows_with_the_load(force, engine):
    """A spin in the hand has the torque of the radius at the load, and the pad's radius is the largest."""
    with bench({"radius_exponent": 1.0 / 3.0}, engine, force=force, inertia=1e-4) as held:
        held.settle()
        radius = min(R * (force / 5.0) ** (1.0 / 3.0), 0.010)
        friction = drag(held, (0.0, 0.0, 1.3 * MU_S * 2.0 * force * radius), 0.1)
    assert -friction[2] == pytest.approx(2.0 * MU_C * force * radius, rel=0.01)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_centre_of_pressure_moves_with_the_load(engine):
    """Its lever gives the slide of a centred mass no torque, but the finger's sensor reads the tilt."""
    lever = 0.01
    with bench({"cop_lever": lever}, engine, force=5.0) as held:
        held.settle()
        friction = drag(held, (1.3 * MU_S * 10.0, 0.0, 0.0))
        centre = held.plant.pads["pressure_centre"][0, 0].copy()
    assert centre[0] == pytest.approx(lever * 0.5 * friction[0] / 5.0, rel=0.01)
    assert abs(centre[1]) < 1e-6


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("contact", ["ellipsoid", "disc"])
def test_anisotropic_friction_is_normal_to_its_own_limit_surface(contact, engine):
    """The limit surface is stretched by its axes; the slip is normal to it, and friction dissipates most."""
    anisotropy = 0.2
    with bench({"anisotropy": anisotropy}, engine, contact, force=5.0, inertia=1.0) as held:
        held.settle()
        held.run(0.15, load=lambda _: (5.0, 6.0, 0.0))
        v_x, v_y, omega = held.plant.world["slip_twist"][0]
        friction = held.plant.pads["wrench"][0].sum(axis=0)
    a, b = 1.0 + anisotropy, 1.0 - anisotropy
    assert math.hypot(v_x, v_y) > 0.02
    assert R * abs(omega) < 1e-3 * math.hypot(v_x, v_y)  # the mass leaves the pads' centre
    scaled = math.hypot(a * v_x, b * v_y)
    expected = -MU_C * 10.0 * np.array([a * a * v_x, b * b * v_y]) / scaled
    assert friction[:2] == pytest.approx(expected, rel=0.01)


def shear(pad: dict, load: float, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and displacements of a mass on two standard linear solids after a step of the load [s, m]."""
    k = 2.0 / pad["shear_compliance"]

    def derivative(_, state):
        p, v, q = state
        force = k * (p - pad["creep"] * q + pad["shear_time"] * v)
        return [v, (load - force) / MASS, (p - q) / pad["creep_time"]]

    times = np.arange(1, round(120 * duration) + 1) / 120.0
    options = {"rtol": 1e-9, "atol": 1e-12}
    return times, solve_ivp(derivative, (0.0, duration), [0.0] * 3, "Radau", times, **options).y[0]


@pytest.mark.quick_cases(
    *("5000.0-ellipsoid-planar", "200000.0-ellipsoid-bullet", "20000.0-disc-planar"),
    *("5000.0-distributed-planar", "200000.0-distributed-planar"),
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("contact", ["ellipsoid", "disc", "distributed"])
@pytest.mark.parametrize("stiffness", [5e3, 2e4, 2e5])
def test_a_pad_shears_and_creeps(stiffness, contact, engine):
    pad = {"shear_compliance": 1.0 / stiffness, "shear_time": 2e-3, "creep": 0.4, "creep_time": 0.3}
    with bench(pad, engine, contact, force=5.0) as held:
        held.settle()
        start = held.plant.world["slip"][0, 0]
        trace = held.run(1.0, load=lambda _: (1.5, 0.0, 0.0))
    times, expected = shear(pad, 1.5, 1.0)
    found = trace.slip[:, 0] - start
    # the bristles behind the rubber give 1.5 N / (2 * 5 N * 1e6 / m) = 0.15 um
    assert found - 1.5e-7 == pytest.approx(expected, abs=0.01 * expected.max())
    assert expected[-1] > 1.3 * expected[len(times) // 10]


@pytest.mark.parametrize("engine", ENGINES)
def test_torsion_shears_with_the_square_of_the_radius(engine):
    compliance, torque = 5e-5, 0.005
    with bench({"shear_compliance": compliance}, engine, force=5.0, inertia=1e-5) as held:
        held.settle()
        trace = held.run(0.5, load=lambda t: (0.0, 0.0, torque * min(1.0, 5.0 * t)))
    assert trace.slip[-1, 2] == pytest.approx(0.5 * torque * compliance / R**2, rel=0.01)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("dwell", [0.5, 4.0])
def test_static_friction_grows_with_dwell_time(dwell, engine):
    pad = {"aging": 0.1, "aging_time": 0.05}
    with bench(pad, engine, force=5.0) as held:
        held.settle()
        rest = float(held.plant.pads["dwell"][0, 0])
        held.run(dwell, load=lambda _: (4.0, 0.0, 0.0))
        rate = 2.0
        broken = held.run(
            2.0,
            load=lambda t: (4.0 + rate * t, 0.0, 0.0),
            until=lambda b: abs(b.plant.world["slip"][0, 0]) > 3e-6,
        )
        total = rest + dwell + broken.time[-1] - broken.time[0]
    expected = 10.0 * (MU_C + (MU_S - MU_C) * (1.0 + 0.1 * math.log1p(total / 0.05)))
    assert broken.load[-1, 0] == pytest.approx(expected, rel=0.01)
    assert expected > 1.04 * 10.0 * MU_S


def test_slip_wears_the_age_of_a_contact_off():
    """Prescribed slip at constant speed against the aging law's own solution."""
    from slipgym.contact.ellipsoid import EllipsoidContact

    contact = EllipsoidContact()
    contact._pads["aging"], contact._pads["aging_distance"] = 0.1, 1e-4
    speed, h = 2e-3, 1e-4
    for _ in range(20000):
        contact.step((0.0, 0.0, 0.0), 5.0, h)
    assert contact._pads["dwell"][0] == pytest.approx(2.0, rel=1e-6)
    for _ in range(1000):
        contact.step((speed, 0.0, 0.0), 5.0, h)
    steady = 1e-4 / speed
    expected = steady + (2.0 - steady) * math.exp(-0.1 / steady)
    assert contact._pads["dwell"][0] == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("contact", ["ellipsoid", "disc", "distributed"])
@pytest.mark.parametrize("seed", range(4))
def test_a_closed_box_of_soft_pads_never_gives_energy(contact, seed):
    """Work against friction under any motion from rest is never negative: nothing was stored at the start."""
    from slipgym.contact.records import PAD

    rng = np.random.default_rng(seed)
    pad = {key: value for key, value in SOFT_PADS.items() if key not in ("cop_lever", "load_exponent")}
    with bench(pad, "planar", contact, force=5.0) as held:
        assert held.plant.pads.dtype == PAD
        held.settle()
        kick = rng.normal(size=(200, 3)) * (8.0, 8.0, 8.0 * R)
        trace = held.run(1.0, load=lambda t: kick[int(t * 60)])
        world, box = held.plant.world[0], held.box
        kinetic = 0.5 * (
            box.mass * float(world["velocity"][0] ** 2 + world["velocity"][1] ** 2)
            + box.inertia * float(world["velocity"][2] ** 2)
        )
    moved = np.diff(trace.position, axis=0, prepend=np.zeros((1, 3)))
    given = np.cumsum(np.einsum("ij,ij->i", trace.load, moved))
    assert kinetic < given[-1]
    assert np.linalg.norm(trace.slip[-1] * (1, 1, R)) > 1e-3


@pytest.mark.parametrize("contact", ["ellipsoid", "disc"])
def test_engines_agree_with_all_of_it(contact):
    """A slide that sticks and slips under a grip that opens and closes."""

    def grip(t):
        return 3.0 - 1.8 * max(0.0, math.sin(2.0 * math.pi * t)) ** 4

    ends = []
    for engine in ENGINES:
        with bench(SOFT_PADS, engine, contact, gravity=9.81, force=3.0, com_offset=(0.002, -0.01)) as held:
            held.settle()
            ends.append(held.run(2.0, force=grip).slip[-1])
    assert np.hypot(*ends[0][:2]) > 2e-3
    assert np.hypot(*(ends[0] - ends[1])[:2]) < 1e-4
    assert abs(ends[0][2] - ends[1][2]) < math.radians(0.1)
