"""The network of "gru" in torch and compiled, its recordings, and its training with a tiny budget."""

import gymnasium as gym
import numpy as np
import pytest
from typer.testing import CliRunner

import estimator
import policies
from lab.learned_estimator import config
from lab.learned_estimator.columns import Sequence, sequences
from lab.learned_estimator.compare import compare, conditions, wide
from lab.learned_estimator.episodes import READINGS, record
from lab.learned_estimator.features import COLUMNS
from lab.learned_estimator.gru import NAME as GRU
from lab.learned_estimator.recorder import NAME
from lab.learned_estimator.weights import SHAPES, load

pytest.importorskip("torch")
import torch

from lab.commands.train_estimator import app
from lab.learned_estimator import fit as fitting
from lab.learned_estimator import run
from lab.learned_estimator.fit import first_weights, fit
from lab.learned_estimator.network import Network
from lab.learned_estimator.run import WEIGHTS, train

LINEAR = "slipgym:slipgym/LinearSlip-v0"
TINY = {
    **config.read().model_dump(mode="json"),
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


@pytest.mark.slow
def test_torch_and_the_compiled_estimator_agree(recordings):
    """float32 with sums in another order; the averages forget, so errors do not grow with the samples."""
    one = recordings[0]
    (sequence,) = sequences([one], 0.0, 0)
    with torch.no_grad():
        found = Network(load())(torch.from_numpy(sequence.columns)[:, None])
    means, deviations = (np.asarray(each)[:, 0] for each in found)
    est, kept = estimator.make(GRU), []
    for k, row in enumerate(one.readings.tolist()):
        est.update((k + 1) / 120, row[:4], row[4:])
        state = est.batch.states[0]
        if state["in_contact"] > 0:
            deviation = np.log(state["sd_lever"] / (state["mu_c"] * state["r"]))
            kept.append((*state["mean"], deviation))
    expected = np.column_stack([means, deviations[:, 3]])
    np.testing.assert_allclose(kept[-len(expected) :], expected, atol=1e-3)


def made_up(lengths, rng):
    """Sequences of random columns, whose targets the first columns tell."""
    columns = [rng.normal(size=(n, COLUMNS)).astype(np.float32) for n in lengths]
    return [Sequence(one, 0.1 * one[:, :3] - 1.0) for one in columns]


def test_sequences_in_a_batch_do_not_touch_each_other():
    rng = np.random.default_rng(0)
    data = made_up((30, 7, 19), rng)
    network = Network(first_weights(data, rng))
    alone = [network.loss([one]).item() * len(one.columns) for one in data]
    assert network.loss(data).item() == pytest.approx(sum(alone) / 56, rel=1e-5)
    again = Network(network.tensors())
    assert again.loss(data).item() == network.loss(data).item()


@pytest.mark.slow
def test_a_fit_learns_and_is_the_same_for_a_seed():
    data = made_up((40,) * 24, np.random.default_rng(1))
    training = config.read({**TINY, "updates": 120, "batch": 8})
    kept = []
    for _ in range(2):
        rows = []
        fit(training, data, 3, lambda tensors, curve, rows=rows: rows.append((tensors, list(curve))), False)
        kept.append(rows)
    (first, second), other = kept[0], kept[1][1]
    assert [row["update"] for row in second[1]] == [100, 120]
    assert second[1][-1]["held_out"] < second[1][0]["training"]
    assert second[1] == other[1]
    assert all((second[0][name] == other[0][name]).all() for name in SHAPES)
    assert (first[0]["head_bias"] != second[0]["head_bias"]).any()
    assert all((second[0][name] == first[0][name]).all() for name in ("centre", "scale"))


def test_the_folder_is_made_before_anything_is_recorded(tmp_path, monkeypatch):
    monkeypatch.setattr(run, "recorded", lambda *_: pytest.fail("recorded before it looked at the output"))
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        train(config.read(TINY), tmp_path / "file" / "runs")
    done = CliRunner().invoke(app, ["--output", str(tmp_path / "file" / "runs")])
    assert done.exit_code == 2
    assert "file" in done.output


def test_what_was_learned_until_an_interrupt_is_kept(tmp_path, monkeypatch):
    data = made_up((10,) * 8, np.random.default_rng(1))
    monkeypatch.setattr(run, "recorded", lambda *_: data)
    monkeypatch.setattr(fitting, "EVERY", 2)
    loss, calls = Network.loss, iter(range(100))

    def interrupted(network, sequences):
        if next(calls) == 6:
            raise KeyboardInterrupt
        return loss(network, sequences)

    monkeypatch.setattr(Network, "loss", interrupted)
    with pytest.raises(KeyboardInterrupt):
        train(config.read(TINY), tmp_path, 0, progress=False)
    (folder,) = tmp_path.iterdir()
    assert set(load(folder / run.UNFINISHED)) == set(SHAPES)
    assert (folder / "curve.csv").read_text().startswith("update,training,held_out\n2,")
    assert not (folder / WEIGHTS).exists()


@pytest.mark.slow  # programs of its own
def test_environments_run_it_and_rows_equal_single_environments():
    many = gym.make_vec(LINEAR, num_envs=3, sensors="lab", estimator=GRU).unwrapped
    many.reset(seed=5)
    one = gym.make(LINEAR, engine="planar", sensors="lab", estimator=GRU).unwrapped
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
    entrants = {"gru": (GRU, {"weights": path}), "disc": ("disc", {})}
    table = compare(training, entrants, rows=2, steps=60, progress=False)
    assert list(table["condition"].unique()) == list(conditions(training))
    assert len(table) == 3 * len(entrants) * len(conditions(training))
    assert len(wide(table)) == len(entrants) * len(conditions(training))
    assert NAME not in estimator.names()
