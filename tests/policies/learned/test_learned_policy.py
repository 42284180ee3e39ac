"""How a learned policy acts; needs no torch."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from policies.learned import LearnedPolicy, files

ROOT = Path(__file__).resolve().parents[3]
PLAIN = {"kind": "mlp", "memory": None, "layers": [], "activation": "tanh", "squash": False}


def rows(policy, n, seed=0):
    width = policy.description.environment.width
    return np.random.default_rng(seed).normal(size=(n, width)).astype(np.float32)


def picking(policy_folder, column, scale=1.0, moments=None, **changes):
    """A policy whose action is one column, times a scale."""
    names = [c.name for c in LearnedPolicy(policy_folder("names")).description.environment.observation]
    weight = np.zeros((1, len(names)), np.float32)
    weight[0, names.index(column)] = scale
    weights = {"layers.0.weight": weight, "layers.0.bias": np.zeros(1, np.float32), **(moments or {})}
    network = {**PLAIN, **changes.pop("network", {})}
    return names.index(column), policy_folder("picking", weights=weights, network=network, **changes)


@pytest.mark.parametrize(("squash", "bound"), [(False, lambda x: np.clip(x, -1.0, 1.0)), (True, np.tanh)])
def test_a_layer_that_picks_a_column_gives_it_back(policy_folder, squash, bound):
    k, folder = picking(policy_folder, "f_n_1", 2.0, normalisation=None, network={"squash": squash})
    policy = LearnedPolicy(folder)
    observations = rows(policy, 50)
    actions, state = policy.predict(observations)
    assert (actions.shape, actions.dtype, state) == ((50, 1), np.float32, None)
    # one product and one bounded function, each rounded to float32
    np.testing.assert_allclose(actions[:, 0], bound(2.0 * observations[:, k]), rtol=4e-7)


def test_observations_are_normalised_and_clipped(policy_folder):
    mean, var = np.zeros(29), np.zeros(29)
    mean[3], var[3] = 7.0, 3.5  # sqrt(var + epsilon) = 2
    moments = {"observation.mean": mean, "observation.var": var}
    k, folder = picking(policy_folder, "tau_1", 0.25, moments, normalisation={"clip": 3.0, "epsilon": 0.5})
    assert k == 3
    observations = np.zeros((4, 29), np.float32)
    observations[:, 3] = 7.0, 9.0, 12.0, -100.0
    actions, _ = LearnedPolicy(folder).predict(observations)
    np.testing.assert_array_equal(actions[:, 0], np.float32([0.0, 0.25, 0.625, -0.75]))


@pytest.mark.parametrize(
    ("activation", "function"),
    [("tanh", math.tanh), ("relu", lambda x: max(x, 0.0)), ("elu", lambda x: x if x > 0 else math.expm1(x))],
)
def test_dense_layers_are_sums_of_products(policy_folder, activation, function):
    folder = policy_folder(network={"activation": activation})
    policy = LearnedPolicy(folder)
    _, w = files.read(folder)
    for x in rows(policy, 5):
        y = [(a - m) / math.sqrt(v + 1e-8) for a, m, v in zip(x, w["observation.mean"], w["observation.var"])]  # noqa: B905
        for k in range(3):
            weight, bias = w[f"layers.{k}.weight"].tolist(), w[f"layers.{k}.bias"].tolist()
            y = [
                b + math.fsum(a * c for a, c in zip(row, y, strict=True))
                for row, b in zip(weight, bias, strict=True)
            ]
            y = [function(a) for a in y] if k < 2 else y
        np.testing.assert_allclose(policy.predict(x)[0], np.clip(y, -1.0, 1.0), atol=2e-6)


def gate(x):
    return 1.0 / (1.0 + math.exp(-x))


def test_lstm_layers_follow_their_equations(policy_folder, lstm):
    folder = policy_folder(**lstm)
    policy = LearnedPolicy(folder)
    _, w = files.read(folder)
    hidden, cell, state = np.zeros((2, 5)), np.zeros((2, 5)), None
    for x in rows(policy, 6):
        y = np.clip((x - w["observation.mean"]) / np.sqrt(w["observation.var"] + 1e-8), -10.0, 10.0)
        for k in range(2):
            z = w[f"memory.{k}.input_weight"] @ y + w[f"memory.{k}.hidden_weight"] @ hidden[k]
            z = z + w[f"memory.{k}.input_bias"] + w[f"memory.{k}.hidden_bias"]
            for j in range(5):
                i, f, g, o = z[j], z[5 + j], z[10 + j], z[15 + j]
                cell[k, j] = gate(f) * cell[k, j] + gate(i) * math.tanh(g)
                hidden[k, j] = gate(o) * math.tanh(cell[k, j])
            y = hidden[k]
        y = np.maximum(w["layers.0.weight"] @ y + w["layers.0.bias"], 0.0)
        action, state = policy.predict(x, state)
        wanted = np.tanh(w["layers.1.weight"] @ y + w["layers.1.bias"])
        np.testing.assert_allclose(action, wanted, atol=1e-6)
        np.testing.assert_allclose(state[0][0], hidden, atol=1e-6)
        np.testing.assert_allclose(state[1][0], cell, atol=1e-6)


@pytest.mark.parametrize("recurrent", [False, True])
def test_rows_of_a_batch_are_episodes_of_their_own(policy_folder, lstm, recurrent):
    policy = LearnedPolicy(policy_folder(**(lstm if recurrent else {})))
    states, state = [None, None, None], None
    begun = np.zeros(3, bool)
    for t in range(8):
        observations = rows(policy, 3, t)
        begun[:] = (False, t == 4, t % 3 == 0)
        actions, state = policy.predict(observations, state, begun)
        for i in range(3):
            single, states[i] = policy.predict(observations[i], None if begun[i] else states[i])
            assert single.shape == (1,)
            # a batch takes its sums in another order: float32 roundings of 6e-8 of terms of order 1
            np.testing.assert_allclose(actions[i], single, atol=2e-6)


def test_memory_belongs_to_the_caller(policy_folder, lstm):
    policy = LearnedPolicy(policy_folder(**lstm))
    _, state = policy.predict(rows(policy, 2))
    kept = [part.copy() for part in state]
    first = policy.predict(rows(policy, 2, 1), state)[0]
    for part, copy in zip(state, kept, strict=True):
        np.testing.assert_array_equal(part, copy)
    np.testing.assert_array_equal(policy.predict(rows(policy, 2, 1), state)[0], first)
    assert not np.array_equal(policy.predict(rows(policy, 2, 1))[0], first)


def test_the_group_policy_is_what_it_reads(policy_folder):
    policy = LearnedPolicy(policy_folder())
    observations = rows(policy, 3)
    groups = {"policy": observations, "privileged": np.full((3, 2), np.nan)}
    np.testing.assert_array_equal(policy.predict(groups)[0], policy.predict(observations)[0])
    with pytest.raises(ValueError, match="no 'policy'"):
        policy.predict({"sensor": observations})


def test_what_does_not_fit_is_refused(policy_folder, lstm):
    policy, recurrent = LearnedPolicy(policy_folder()), LearnedPolicy(policy_folder("lstm", **lstm))
    good = rows(policy, 2)
    for bad in (good[:, :-6], good[None], np.float32(1.0), np.hstack([good, good])):
        with pytest.raises(ValueError, match="observation"):
            policy.predict(bad)
    with pytest.raises(ValueError, match=r"23 columns.*first that it lacks at its end is 'mu_s'"):
        policy.predict(good[:, :-6])
    with pytest.raises(ValueError, match=r"column 2 \(f_n_1\) must be finite"):
        policy.predict(np.where(np.arange(good.shape[1]) == 2, np.nan, good))
    with pytest.raises(ValueError, match="deterministic"):
        policy.predict(good, deterministic=False)
    with pytest.raises(ValueError, match="state must be None"):
        policy.predict(good, np.zeros((2, 1)))
    with pytest.raises(ValueError, match=r"state has shapes .* 2 observations need"):
        recurrent.predict(good, recurrent.predict(good[:1])[1])
    with pytest.raises(ValueError, match=r"episode_start must have shape \(2,\)"):
        recurrent.predict(good, None, np.array([True]))


def test_weights_that_overflow_give_no_action(policy_folder):
    large = {"layers.0.weight": np.full((8, 29), 3e38, np.float32), "layers.0.bias": np.zeros(8, np.float32)}
    mixed = {"layers.1.weight": np.tile(np.float32([3e38, -3e38]), (6, 4))}
    policy = LearnedPolicy(policy_folder(weights={**large, **mixed}, network={"activation": "relu"}))
    with pytest.raises(ValueError, match="too large"):
        policy.predict(np.full(29, 10.0, np.float32))


def test_neither_import_nor_acting_needs_torch(policy_folder):
    code = (
        "import sys\n"
        "sys.modules.update(torch=None, stable_baselines3=None, sb3_contrib=None, onnx=None)\n"
        "import numpy, policies, policies.learned.export\n"
        f"policy = policies.load({str(policy_folder())!r})\n"
        "print(policy.predict(numpy.zeros(29, 'f4'))[0].shape)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert "(1,)" in done.stdout, done.stderr
