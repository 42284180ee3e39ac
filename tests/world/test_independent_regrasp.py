"""A grip that opens and closes again, against an independent integration of the fall between."""

import math

import pytest
from scipy.integrate import solve_ivp

from slipgym.validation.bench import Bench, Friction

MU_S, MU_C, MASS, GRIP = 0.5, 0.4, 0.2, 6.0


def fall(bench: Bench, opened: float, duration: float) -> float:
    """Displacement at the end [m]; the grip is opened at time 0 and closed after `opened` [s]."""
    gripper, contact, g = bench.config.gripper, bench.config.contact, bench.config.physics.gravity
    off, on = gripper.dead_time, gripper.dead_time + opened

    def grip(t):
        if t < off:
            return GRIP
        rest = GRIP * math.exp(-(min(t, on) - off) / gripper.lag)
        return rest if t < on else GRIP + (rest - GRIP) * math.exp(-(t - on) / gripper.lag)

    def derivative(t, state):
        v = state[1]
        level = MU_C + (MU_S - MU_C) * math.exp(-((v / contact.stribeck_velocity) ** 2)) + contact.sigma_2 * v
        return [v, g - 2.0 * grip(t) * level / MASS]

    def stopped(t, state):
        return state[1]

    stopped.terminal, stopped.direction = True, -1
    start = off + gripper.lag * math.log(2.0 * MU_S * GRIP / (MASS * g))  # the weight reaches the limit
    options = {"rtol": 1e-10, "atol": 1e-13, "max_step": 1e-4}
    solution = solve_ivp(derivative, (start, duration), [0.0, 1e-9], "LSODA", events=stopped, **options)
    assert solution.t_events[0].size == 1
    return float(solution.y[0, -1])


@pytest.mark.parametrize("engine", ["planar", "bullet"])
@pytest.mark.parametrize("opened", [0.05, 0.1, 0.2])
def test_the_object_is_caught_where_an_independent_integration_catches_it(engine, opened):
    friction = Friction(mu_s=MU_S, mu_c=MU_C)
    with Bench(friction=friction, force=GRIP, mass=MASS, size=(0.08, 0.03, 1.6), engine=engine) as bench:
        bench.settle()
        away = float(bench.plant.world["slip"][0, 1])
        bench.run(opened, force=lambda _: 0.0)
        bench.run(0.4, force=lambda _: GRIP)
        found = away - float(bench.plant.world["slip"][0, 1])
        expected = fall(bench, opened, opened + 0.4)
    assert expected > 0.005
    # the open grip loses the last of its force when it lets the object go at 10 mN: friction of an impulse of
    # 2 * 0.4 * 10 mN * 12 ms, 0.5 mm/s, which in 0.2 s of falling is 0.1 mm
    assert found == pytest.approx(expected, abs=1.5e-4)
