"""The split of a step's time runs the programs of the step itself and leaves nothing out."""

import numpy as np
import pytest

from lab.benchmarking import split
from slipgym.benchmarking.run import VectorPlayer

pytestmark = pytest.mark.slow  # they compile a program that only the benchmark runs


@pytest.fixture(scope="module")
def player():
    player = VectorPlayer("slipgym/LinearSlip-v0", 8, threads=1)
    yield player
    player.env.close()


def test_the_parts_add_up_to_the_step(player):
    found = split.Split(player).pair()
    parts = [found[name] for name in (*split.STAGES, split.BETWEEN, split.RESETS, split.REST)]
    assert sum(parts) == pytest.approx(found[""])
    assert all(found[name] > 0.0 for name in (*split.STAGES, split.COMPILED, split.REST))
    assert found["sub-steps"] >= 1.0


def test_stage_by_stage_a_step_is_that_of_the_environment(player):
    split.Split(player).pair()  # until an action is there
    env, taken = player.env, split.Split(player)
    simulation, state = env.simulation, env.get_state()
    action = np.full((player.n, 1), player.actions[1], np.float32)
    env.step(action)
    moving = simulation.rewards != 0.0  # the others were reset
    expected = [simulation.plant.world[moving].copy(), simulation.estimated[moving].copy()]
    env.set_state(state)
    taken._action[0][:] = action
    for program in split.STAGES.values():
        taken._run[program]()
    assert moving.any()
    for array, wanted in zip((simulation.plant.world, simulation.estimated), expected, strict=True):
        assert array[moving].tobytes() == wanted.tobytes()


def test_the_contact_kernel_is_timed_on_a_copy(player):
    before = player.env.simulation.plant.pads.tobytes()
    assert split.Split(player)._contact_step() > 0.0
    assert player.env.simulation.plant.pads.tobytes() == before


def test_every_figure_has_a_name_of_its_own(player):
    names = [figure.name for figure in split.parts(player, 3)]
    assert len(set(names)) == len(names)
    assert names[0].startswith("batch step")
    assert "batch step / its contact kernel" in names


def test_every_step_belongs_to_a_regime(player):
    taken = split.Split(player)
    for _ in range(2):
        taken.pair()
    steps, substeps = taken.tally.T
    assert steps.sum() == 2 * split.STEPS * player.n
    assert (substeps >= steps).all()
    shares = [figure.value for figure in split._regimes(taken.tally) if figure.name.startswith("fraction")]
    assert sum(shares) == pytest.approx(1.0)
