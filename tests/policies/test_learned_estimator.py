"""The network of "gru" in torch and compiled, its recordings, and its training with a tiny budget."""

import gymnasium as gym
import numpy as np
import pytest

import estimator
import policies
from estimator.network.weights import SHAPES, load
from policies.research.learned_estimator import config
from policies.research.learned_estimator.columns import sequences
from policies.research.learned_estimator.compare import compare, conditions
from policies.research.learned_estimator.episodes import cells, record
from policies.research.learned_estimator.recorder import NAME
from slipgym.sensors.unloaded import READINGS

LINEAR = "slipgym:slipgym/LinearSlip-v0"
TINY = {
    **config.read("gru").model_dump(mode="json"),
    **{"tasks": ["linear_slip"], "friction_sources": ["true"], "contacts": ["ellipsoid"]},
    **{"rows": 8, "steps": 60, "updates": 6, "batch": 4},
}


@pytest.fixture(scope="module")
def recordings():
    return list(record("linear_slip", 4, 90, 3, disturbed=0.5, sensors="lab", randomization="lab"))


def test_a_recording_is_what_the_estimator_gets():
    """Wrenches and twists of an environment with another estimator, whose controller acts on the truth."""
    (first, second) = record("linear_slip", 1, 60, 7, sensors="lab", friction_source="true")
    policy = policies.make("linear_slip")
    arguments = {"sensors": "lab", "friction_source": "true", **policies.modes(policy)}
    env = gym.make_vec(LINEAR, num_envs=1, **arguments).unwrapped
    observation, _ = env.reset(seed=7)
    memory = None
    for k in range(60):
        action, memory = policy.predict(observation, memory, np.array([k == 0]))
        observation, *_ = env.step(action)
        readings = np.concatenate([env.simulation.wrenches[0], env.simulation.twists[0]], axis=-1)
        at = READINGS + k + (len(first.readings) - READINGS - 60)
        np.testing.assert_array_equal(first.readings[at], readings[0].astype(np.float32))
        np.testing.assert_array_equal(second.readings[at], readings[1].astype(np.float32))
    env.close()


def test_the_truth_of_a_recording_begins_with_the_grasp(recordings):
    assert len(recordings) == 8
    for one in recordings:
        assert np.isnan(one.truth[: READINGS - 1]).all()
        assert np.isfinite(one.truth[-60:]).all()
        assert (np.abs(one.readings[: READINGS - 1, 2]) < 0.6).all()


def test_torch_and_the_compiled_network_agree(recordings):
    """float32 with sums in another order; the averages forget, so errors do not grow with the samples."""
    torch = pytest.importorskip("torch")
    from policies.research.learned_estimator.network import Network

    own = load()
    network = Network(own["centre"], own["scale"], own["start"])
    state = {
        "unit.weight_ih_l0": own["input_weight"].T,
        "unit.bias_ih_l0": own["input_bias"],
        "unit.weight_hh_l0": own["hidden_weight"].T,
        "unit.bias_hh_l0": own["hidden_bias"],
        "head.weight": np.concatenate([own["head_of_hidden"], own["head_of_columns"]]).T,
        "head.bias": own["head_bias"],
        **{name: own[name] for name in ("centre", "scale", "start")},
    }
    network.load_state_dict({name: torch.tensor(np.array(value)) for name, value in state.items()})
    for name, tensor in network.tensors().items():
        np.testing.assert_array_equal(tensor, own[name])
    one = recordings[0]
    (sequence,) = sequences([one], 0.0, 0)
    with torch.no_grad():
        means, deviations = network(torch.from_numpy(sequence.columns)[:, None])
    batch = estimator.make_batch("gru", 1)
    kept = []
    for k, row in enumerate(one.readings.astype(float)):
        batch.update((k + 1) / 120, row[None, :4].copy(), row[None, 4:].copy())
        if batch.states["in_contact"][0] > 0:
            kept.append((batch.states["mean"][0].copy(), batch.estimates["sd_mu_c"][0], batch.estimates["mu_c"][0]))
    kept = kept[-len(sequence.columns) :]
    np.testing.assert_allclose([mean for mean, *_ in kept], means[:, 0], atol=2e-4)
    if batch.states["updates_mu_c"][0] > 0:
        _, sd, mu_c = kept[-1]
        assert np.log(sd / mu_c) == pytest.approx(float(deviations[-1, 0, 1]), abs=2e-3)


def test_environments_run_it_and_rows_equal_single_environments():
    many = gym.make_vec(LINEAR, num_envs=3, sensors="lab", estimator="gru").unwrapped
    many.reset(seed=5)
    one = gym.make(LINEAR, engine="planar", sensors="lab", estimator="gru").unwrapped
    one.reset(seed=7)
    for _ in range(14):
        action = np.full((3, 1), -1.0, np.float32)
        many.step(action)
        one.step(action[0])
    found = many.simulation.estimator.estimates[4:]
    assert found.tolist() == one.simulation.estimator.estimates.tolist()
    assert (found["updates_mu_c"] > 0).all()
    assert one.simulation.estimator.estimates["confidence_mu_c"].min() > 0.0
    many.close()
    one.close()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tasks": ["linear"]}, "linear"),
        ({"disturbed": 2.0}, "disturbed"),
        ({"rows": 0}, "rows"),
        ({"randomization": {"mu": 1}}, "mu"),
        ({"hidden": 64}, "hidden"),
        ({"friction_sources": ["none"]}, "friction_sources"),
    ],
)
def test_a_wrong_training_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        config.read({**TINY, **change})


def test_cells_are_all_combinations():
    found = list(cells({"a": [1, 2], "b": "xy"}))
    assert found == [{"a": 1, "b": "x"}, {"a": 1, "b": "y"}, {"a": 2, "b": "x"}, {"a": 2, "b": "y"}]


@pytest.mark.slow
def test_training_is_deterministic_and_its_weights_are_used(tmp_path):
    pytest.importorskip("torch")
    from policies.research.learned_estimator.run import WEIGHTS, train

    training = config.read(TINY)
    folders = [train(training, tmp_path / name, 1, progress=False) for name in ("a", "b")]
    assert folders[0].joinpath(WEIGHTS).read_bytes() == folders[1].joinpath(WEIGHTS).read_bytes()
    path = str(folders[0] / WEIGHTS)
    assert set(load(path)) == set(SHAPES)
    assert (folders[0] / "curve.csv").read_text().startswith("update,training,held_out\n6,")
    entrants = {"gru": ("gru", {"weights": path}), "disc": ("disc", {})}
    table = compare(training, entrants, rows=2, steps=60, progress=False)
    assert list(table["condition"].unique()) == list(conditions(training))
    assert len(table) == 3 * len(entrants) * len(conditions(training))
    assert NAME not in estimator.names()
