"""The network of "gru" in torch and compiled, its recordings, and its training with a tiny budget."""

import gymnasium as gym
import numpy as np
import pytest

import estimator
import policies
from estimator.network.cell import HIDDEN
from estimator.network.features import COLUMNS
from estimator.network.weights import SHAPES, load
from lab.learned_estimator import config
from lab.learned_estimator.columns import Sequence, sequences
from lab.learned_estimator.compare import compare, conditions, wide
from lab.learned_estimator.episodes import READINGS, record
from lab.learned_estimator.fit import first_weights
from lab.learned_estimator.gradient import loss, loss_and_gradient
from lab.learned_estimator.recorder import NAME
from lab.learned_estimator.run import WEIGHTS, train

LINEAR = "slipgym:slipgym/LinearSlip-v0"
TINY = {
    **config.read("gru").model_dump(mode="json"),
    "tasks": ["linear_slip"],
    "friction_sources": ["true"],
    "contacts": ["ellipsoid"],
    "rigid_contacts": [],
    "rows": 8,
    "steps": 60,
    "updates": 6,
    "batch": 4,
}


@pytest.fixture(scope="module")
def recordings():
    return list(record("linear_slip", 4, 90, 3, disturbed=0.5, sensors="lab"))


@pytest.mark.slow
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


@pytest.mark.slow
def test_the_truth_of_a_recording_begins_with_the_grasp(recordings):
    assert len(recordings) == 8
    for one in recordings:
        assert np.isnan(one.truth[: READINGS - 1]).all()
        assert np.isfinite(one.truth[-60:]).all()
        assert (np.abs(one.readings[: READINGS - 1, 2]) < 0.6).all()


def in_torch(tensors, columns):
    """The network by `torch.nn.GRU`: averages (n, 3) and logarithms of the deviations (n, 4)."""
    torch = pytest.importorskip("torch")
    own = {name: value if torch.is_tensor(value) else torch.tensor(value) for name, value in tensors.items()}
    unit = torch.nn.GRU(COLUMNS, HIDDEN)
    state = {
        "weight_ih_l0": own["input_weight"].T,
        "bias_ih_l0": own["input_bias"],
        "weight_hh_l0": own["hidden_weight"].T,
        "bias_hh_l0": own["hidden_bias"],
    }
    x = (torch.tensor(columns) - own["centre"]) * own["scale"]
    hidden = torch.func.functional_call(unit, state, (x[:, None],))[0][:, 0]
    out = hidden @ own["head_of_hidden"] + x @ own["head_of_columns"] + own["head_bias"]
    mean, means = own["start"], []
    for row in out:
        mean = torch.lerp(mean, row[3:6], torch.sigmoid(row[:3]))
        means.append(mean)
    return torch.stack(means), np.log(0.01) * (1.0 - torch.sigmoid(out[:, 6:]))


@pytest.mark.slow
def test_torch_and_the_compiled_estimator_agree(recordings):
    """float32 with sums in another order; the averages forget, so errors do not grow with the samples."""
    one = recordings[0]
    (sequence,) = sequences([one], 0.0, 0)
    means, deviations = (np.asarray(found) for found in in_torch(load(), sequence.columns))
    est, kept = estimator.make("gru"), []
    for k, row in enumerate(one.readings.tolist()):
        est.update((k + 1) / 120, row[:4], row[4:])
        state = est.batch.states[0]
        if state["in_contact"] > 0:
            deviation = np.log(state["sd_lever"] / (state["mu_c"] * state["r"]))
            kept.append((*state["mean"], deviation))
    expected = np.column_stack([means, deviations[:, 3]])
    np.testing.assert_allclose(kept[-len(expected) :], expected, atol=1e-3)


@pytest.mark.slow
def test_the_gradient_is_that_of_torch(recordings):
    torch = pytest.importorskip("torch")
    data = [Sequence(one.columns[:40], one.targets[:40]) for one in sequences(recordings[:3], 0.0, 0)]
    network = first_weights(data, np.random.default_rng(0))
    value, gradient = loss_and_gradient(network, data)
    assert loss(network, data) == value
    own = {name: torch.tensor(network[name][0].copy(), requires_grad=True) for name in SHAPES}
    each = []
    for one in data:
        means, deviations = in_torch(own, one.columns)
        errors = torch.tensor(one.targets, dtype=torch.float32) - means
        errors = torch.cat([errors, errors[:, 1:2] + errors[:, 2:3]], dim=1)
        each.append((0.5 * (errors * torch.exp(-deviations)) ** 2 + deviations).mean(dim=1))
    mean = torch.cat(each).mean()
    mean.backward()
    assert value == pytest.approx(mean.item(), rel=1e-5)
    for name in set(SHAPES) - {"centre", "scale"}:
        expected = own[name].grad.numpy()
        error = np.abs(gradient[name][0] - expected).max()
        assert error < 1e-4 * np.abs(expected).max(), name  # float32, sums of 120 samples


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


def test_a_training_has_all_combinations_and_rigid_pads_without_ranges_of_rubber():
    found = config.read({**TINY, "tasks": ["Hinge", "hold"], "rigid_contacts": ["disc"]}).episodes()
    assert [(one["task"], one["contact"]) for one in found] == [
        *(("hinge", "ellipsoid"), ("hinge", "disc")),
        *(("hold", "ellipsoid"), ("hold", "disc")),
    ]
    assert ["creep" in one["randomization"] for one in found] == [True, False, True, False]


@pytest.mark.slow
def test_training_is_deterministic_and_its_weights_are_used(tmp_path):
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
    assert len(wide(table)) == len(entrants) * len(conditions(training))
    assert NAME not in estimator.names()
