"""The force loop against its analytic step response."""

import math

import numpy as np
import pytest

from slipgym.validation.bench import Bench

LAG, DEAD = 0.012, 0.004


def response(t: np.ndarray, start: float, end: float) -> np.ndarray:
    """First-order step response after a dead time."""
    return np.where(t < DEAD, start, end + (start - end) * np.exp(-(t - DEAD) / LAG))


@pytest.mark.parametrize(("start", "end"), [(5.0, 12.0), (12.0, 3.0)])
def test_step_response_is_dead_time_and_lag(start, end):
    with Bench(force=start) as bench:
        bench.settle()
        trace = bench.run(0.15, force=lambda _: end)
        t = bench.step_time * np.arange(1, len(trace.time) + 1)
    # the lag is integrated exactly; dead time and steps are whole ticks of 1/12000 s
    np.testing.assert_allclose(trace.force, np.tile(response(t, start, end)[:, None], 2), rtol=1e-12)


def test_the_pads_press_with_the_actuator_force_while_it_changes():
    with Bench(force=5.0) as bench:
        bench.settle()
        trace = bench.run(0.15, force=lambda _: 12.0)
        t = bench.step_time * np.arange(1, len(trace.time) + 1)
        h = bench.engine_time
    # the engine's normal force is the mean over its last step, up to the acceleration of the 0.1 kg fingers
    ends = [response(t - shift, 5.0, 12.0) for shift in np.linspace(0.0, h, 101)]
    np.testing.assert_allclose(trace.normal, np.tile(np.mean(ends, axis=0)[:, None], 2), rtol=5e-3)


def test_commands_in_the_dead_time_queue_up():
    overrides = {"gripper": {"dead_time": 0.05, "lag": 0.0}}
    with Bench(overrides, force=5.0) as bench:
        trace = bench.run(0.2, force=lambda t: 6.0 + round(120 * t))
    # 0.05 s are six control steps: the command of step k acts from the end of step k + 6 - 1 on
    expected = np.concatenate([np.full(6, 5.0), 6.0 + np.arange(len(trace.time) - 6)])
    np.testing.assert_array_equal(trace.force[:, 0], expected)


@pytest.mark.parametrize("force", [40.0, 55.0, 1e6])
def test_hard_limit(force):
    with Bench() as bench:
        trace = bench.run(0.4, force=lambda _: force)
    assert trace.force.max() <= 40.0
    np.testing.assert_allclose(trace.force[-1], 40.0, rtol=1e-9)


@pytest.mark.parametrize(("force", "kept"), [(0.499, 0.0), (0.0, 0.0), (-3.0, 0.0), (0.5, 0.5)])
def test_small_commands_open_the_force_loop(force, kept):
    with Bench({"physics": {"gravity": 0.0}}) as bench:
        trace = bench.run(0.4, force=lambda _: force)
    np.testing.assert_allclose(trace.force[-1], kept, atol=5.0 * math.exp(-(0.4 - DEAD) / LAG) * 1.01)


def test_both_pads_press_with_the_grip_at_rest():
    for force in (0.6, 5.0, 25.0):
        with Bench({"physics": {"gravity": 0.0}}, force=force) as bench:
            np.testing.assert_allclose(bench.settle().normal[-1], force, rtol=1e-3)


def masing(commands: np.ndarray, start: float, stiction: float) -> np.ndarray:
    """Force of a friction element by Masing's rule, from the virgin curve through (start, start).

    After a turn the curve is the virgin one, twice as large; a loop that closes is forgotten (Madelung).
    """

    def virgin(x: float) -> float:
        return math.copysign(max(abs(x) - stiction, 0.0), x)

    turns, last, way, forces = [], (start, start), 0.0, []
    for command in commands.tolist():
        now = math.copysign(1.0, command - last[0]) if command != last[0] else way
        if way * now < 0.0:
            turns.append(last)
        way = now
        while turns:
            closing = turns[-2][0] if len(turns) > 1 else 2.0 * start - turns[0][0]
            if (command - closing) * way < 0.0:
                break
            del turns[-2:]
        u, f = turns[-1] if turns else (start, start)
        force = f + 2.0 * virgin(0.5 * (command - u)) if turns else start + virgin(command - start)
        last = command, force
        forces.append(force)
    return np.array(forces)


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_stiction_obeys_masings_rule(engine):
    overrides = {"gripper": {"stiction": 0.8, "lag": 0.0, "dead_time": 0.0}}
    commands = np.random.default_rng(3).uniform(6.0, 14.0, 200)
    with Bench(overrides, force=10.0, engine=engine) as bench:
        trace = bench.run(199.5 / 120, force=lambda t: commands[round(120 * t)])
    expected = masing(commands[: len(trace.force)], 10.0, 0.8)
    np.testing.assert_allclose(trace.force, np.tile(expected[:, None], 2), rtol=1e-12)
    assert np.abs(expected - commands[: len(expected)]).max() <= 0.8 + 1e-12


def test_the_work_lost_in_a_loop_of_stiction():
    """Between forces that differ by R, a loop loses 2 F (R - 2 F), however long it takes."""
    commands = 8.0 + np.tile(np.concatenate([np.arange(60), np.arange(60, 0, -1)]), 2) / 10
    overrides = {"gripper": {"stiction": 0.5, "lag": 0.0, "dead_time": 0.0}}
    with Bench(overrides, force=8.0, engine="planar") as bench:
        trace = bench.run(len(commands) / 120, force=lambda t: commands[round(120 * t)])
    u, f = commands[119:], trace.force[119:, 0]
    assert -np.trapezoid(f, u) == pytest.approx(2 * 0.5 * (6.0 - 1.0), rel=1e-9)


def test_an_open_force_loop_leaves_no_force_to_stiction():
    overrides = {"gripper": {"stiction": 0.4, "lag": 0.0}, "physics": {"gravity": 0.0}}
    with Bench(overrides, force=5.0, engine="planar") as bench:
        assert bench.run(0.1, force=lambda _: 0.0).force[-1].max() == 0.0
        np.testing.assert_allclose(bench.run(0.1, force=lambda _: 3.0).force[-1], 2.6)
