"""Stick in a wrist that accelerates: its limit and, after every sub-step, its friction."""

import math

import numpy as np
import pytest

from lab.validation.accelerated import BOUND, DIRECTIONS, DRIFT_BOUND, break_away, shake
from slipgym.validation.bench import Bench, Friction
from slipgym.world.substep import advance_object

FRICTION = Friction(mu_s=0.5, mu_c=0.4)
MASS, FORCE = 0.2, 5.0


@pytest.mark.quick_cases(
    *("-x-4-bullet", "oblique-2-bullet", "oblique-8-bullet", "pitch-5-bullet"),
    *("-x-2-planar", "oblique-5-planar", "pitch-8-planar"),
)
@pytest.mark.parametrize("engine", ["planar", "bullet"])
@pytest.mark.parametrize("engine_steps", [2, 4, 5, 8])
@pytest.mark.parametrize("name", ["-x", "oblique", "pitch"])
def test_a_wrist_that_accelerates_breaks_the_object_away_at_the_static_limit(name, engine_steps, engine):
    load = break_away(DIRECTIONS[name], engine_steps, engine=engine)
    assert 100.0 * abs(load - 1.0) < BOUND


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_patches_break_away_at_the_same_limit(engine):
    load = break_away(DIRECTIONS["+x"], engine=engine, contact="distributed")
    assert 100.0 * abs(load - 1.0) < BOUND


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_a_shaken_wrist_leaves_the_object_where_it_is(engine):
    moved, wrong = shake(DIRECTIONS["oblique"], 2.0, engine=engine)
    assert moved < DRIFT_BOUND
    assert 100.0 * wrong < BOUND


@pytest.mark.parametrize("seed", range(3))
def test_friction_is_the_load_after_every_sub_step(seed):
    """Sub-steps of random lengths, 1 to 12 ticks, in a wrist that is shaken at 90 % of the limit."""
    rng = np.random.default_rng(seed)
    with Bench(
        {"physics": {"gravity": 0.0}}, friction=FRICTION, force=FORCE, mass=MASS, engine="planar"
    ) as bench:
        world, tick = bench.plant.world[0], float(bench.plant.world["tick_length"][0])
        pads = bench.plant.pads[0, 0], bench.plant.pads[0, 1]
        eyes = bench.plant.slip_sensors[0, 0], bench.plant.slip_sensors[0, 1]
        for pad in pads:
            pad["normal"] = FORCE
        limit = 2.0 * FRICTION.mu_s * FORCE
        omega, t, wrong = 2.0 * math.pi * 5.0, 0.0, 0.0
        heading = np.array([0.6, 0.8, 0.0])
        for _ in range(4000):
            h = tick * int(rng.integers(1, 13))
            acceleration = 0.9 * limit / MASS * math.sin(omega * (t + 0.5 * h))
            world["wrist_acceleration"] = acceleration * heading
            advance_object(world, pads, None, eyes, h)
            t += h
            friction = pads[0]["wrench"] + pads[1]["wrench"]
            wrong = max(wrong, float(np.linalg.norm(friction - MASS * acceleration * heading)))
        assert wrong < 0.01 * limit
        assert np.hypot(*world["slip"][:2]) == 0.0 or np.hypot(*world["relative"][:2]) < 1e-6
