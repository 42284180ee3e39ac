"""The scenes of the slip suite, in the engines that are installed."""

import math

import numpy as np
import pytest

from lab import suite
from lab.suite import bullet_rig, mujoco_rig, scenes, slipgym_rig, table, truth
from lab.suite.rig import Grasp, R, Variant, library

PLANAR = slipgym_rig.variants()[1]
BULLET = bullet_rig.variants()[0]
BEST = mujoco_rig.variants()[5]
CASES = [
    pytest.param(PLANAR, id="slipgym"),
    pytest.param(BULLET, id="bullet"),
    pytest.param(BEST, id="mujoco"),
]


@pytest.fixture(params=CASES)
def variant(request):
    if request.param.engine == "mujoco":
        pytest.importorskip("mujoco")
    return request.param


def test_a_held_object_stays(variant):
    held = scenes.hold(variant, 1.0, 1.0)
    assert held.distance < 1e-4
    assert held.angle < 1e-4
    assert held.duration == 1.0
    assert not held.lost


def test_the_wrist_moves_as_prescribed_and_takes_the_object_along(variant):
    rig = variant.make(Grasp(force=20.0))
    scenes.run(rig, 0.2, lambda _: np.zeros(3))
    slip = scenes.run(rig, 0.3, lambda _: np.zeros(3), lambda t: np.array([0.1, -0.05]) * min(1.0, 10.0 * t))
    assert rig.wrist == pytest.approx([0.025, -0.0125], rel=0.05)
    assert np.abs(slip[-1]).max() < 1e-4
    rig.close()


def test_pure_sliding_and_pure_spin_meet_the_full_friction(variant):
    for gamma, expected in ((1.0, (1.0, 0.0)), (0.0, (0.0, 1.0))):
        measured, exact = scenes.steady(variant, gamma)
        assert (math.hypot(*measured[:2]), abs(measured[2])) == pytest.approx(expected, abs=0.05)
        assert (math.hypot(*exact[:2]), abs(exact[2])) == pytest.approx(expected, abs=0.1)


def test_bullet_decouples_sliding_from_spin():
    measured, _ = scenes.steady(BULLET, 0.7)
    assert math.hypot(*measured[:2]) == pytest.approx(1.0, abs=0.02)
    assert abs(measured[2]) == pytest.approx(1.0, abs=0.02)


def test_the_ellipsoid_couples_them():
    measured, _ = scenes.steady(PLANAR, 0.7)
    assert np.linalg.norm(measured) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.slow
def test_break_away_under_a_force_is_at_the_limit(variant):
    assert scenes.ramp(variant, 1.0) == pytest.approx(0.0, abs=1.0)


def test_exact_friction_of_the_disc():
    assert truth.friction(np.array([0.1, 0.0, 0.0])) == pytest.approx([-1.0, 0.0, 0.0])
    assert truth.friction(np.array([0.0, 0.0, -0.1])) == pytest.approx([0.0, 0.0, 1.0])
    both = truth.friction(scenes.along(0.7))
    assert 0.7**2 < both @ both < 1.0


def test_a_thrown_object_slides_as_far_as_energy_says():
    grasp = Grasp()
    slid = truth.slide(grasp, np.array([0.1, 0.0, 0.0]), 1e-5)
    assert slid == pytest.approx([0.5 * grasp.mass * 0.1**2 / grasp.limit, 0.0, 0.0], rel=1e-2)
    spinning = truth.slide(scenes.SLIDING, np.array([0.05, 0.0, 0.1 / R]))
    straight = truth.slide(scenes.SLIDING, np.array([0.05, 0.0, 0.0]))
    assert np.hypot(*spinning[:2]) > 1.5 * np.hypot(*straight[:2])


def test_the_shaken_wrist_starts_and_ends_at_rest():
    assert scenes.shake(0.0) == pytest.approx([0.0, 0.0])
    assert scenes.shake(scenes.SHAKE_TIME) == pytest.approx([0.0, 0.0])
    speeds = [np.hypot(*scenes.shake(t)) for t in np.linspace(0.0, scenes.SHAKE_TIME, 500)]
    assert 0.3 < max(speeds) < 0.5


def test_tables_have_a_row_for_each_result():
    held = scenes.Held(3.0, 0.5, 60.0, 0.01)
    lost = scenes.Held(120.0, 5.0, 9.0, 0.02)
    friction = np.zeros((len(scenes.GAMMAS), 2, 3))
    ramps = {"force": 0.2, "torque": -10.0, "both": math.inf}
    result = table.Result(Variant("e", "s", PLANAR.make), 2.0, lost, held, ramps, friction, 0.0, 1e-9)
    head, _, row = suite.results_table([result]).splitlines()
    assert head.count("|") == row.count("|")
    assert all(cell in row for cell in ("| lost after 9 s |", "| < -10 |", "| > +50 |", "| < 1e-6 |"))
    assert len(suite.friction_table([result]).splitlines()) == 4


def test_a_missing_engine_is_named():
    with pytest.raises(RuntimeError, match=r"the engine x needs no_such_module.*pip install y"):
        library("no_such_module", "y", "the engine x")


def test_every_engine_has_variants_without_being_installed():
    found = suite.variants(suite.ENGINES)
    assert {variant.engine for variant in found} == set(suite.ENGINES)
    assert all(any(variant.drawn for variant in found if variant.engine == name) for name in suite.ENGINES)
