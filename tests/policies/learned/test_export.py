"""Models of Stable-Baselines3 and their files act alike."""

import json
import re
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.learned import LearnedPolicy, export, files
from policies.learned.description import TRAINING, WEIGHTS

ROOT = Path(__file__).resolve().parents[3]
ENV = "slipgym/Hold-v0"
ARGUMENTS = {"friction_source": "true", "history": 1}
MODELS = {
    "PPO": ("stable_baselines3", "MlpPolicy", {"policy_kwargs": {"net_arch": {"pi": [32, 16], "vf": [24]}}}),
    "SAC": ("stable_baselines3", "MlpPolicy", {"policy_kwargs": {"net_arch": {"pi": [32], "qf": [16, 16]}}}),
    "TQC": ("sb3_contrib", "MlpPolicy", {"policy_kwargs": {"net_arch": [32, 32], "n_quantiles": 7}}),
    "RecurrentPPO": (
        "sb3_contrib",
        "MlpLstmPolicy",
        {"policy_kwargs": {"net_arch": [16], "lstm_hidden_size": 12, "n_lstm_layers": 2}},
    ),
}


@pytest.fixture(scope="module")
def torch():
    found = pytest.importorskip("torch")
    pytest.importorskip("sb3_contrib")
    found.set_num_threads(1)
    return found


@pytest.fixture(scope="module")
def venv(torch):
    """The environment, with moments as after some training."""
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    wrapped = VecNormalize(DummyVecEnv([lambda: gym.make(ENV, **ARGUMENTS)]))
    wrapped.seed(0)
    wrapped.reset()
    for force in np.linspace(-0.5, 0.5, 40):
        wrapped.step(np.array([[force]]))
    yield wrapped
    wrapped.close()


def made(name, env, seed=0, **changes):
    """An untrained model with a last layer that makes its actions fill their range."""
    module, policy, arguments = MODELS[name]
    algorithm = getattr(pytest.importorskip(module), name)
    buffer = {"buffer_size": 10} if name in ("SAC", "TQC") else {}
    model = algorithm(policy, env, seed=seed, device="cpu", **{**arguments, **buffer, **changes})
    head = model.policy.actor.mu if hasattr(model.policy, "actor") else model.policy.action_net
    head.weight.data *= {"PPO": 100.0, "RecurrentPPO": 300.0}.get(name, 3.0)
    return model


def observations(venv, n, seed=0):
    """Around what the environment gives, some of it beyond the clipping."""
    rng, moments = np.random.default_rng(seed), venv.obs_rms
    scaled = 2.0 * rng.standard_t(3, size=(n, len(moments.mean)))
    return (moments.mean + scaled * np.sqrt(moments.var + venv.epsilon)).astype(np.float32)


@pytest.mark.parametrize("normalised", [True, False])
@pytest.mark.parametrize("name", MODELS)
def test_file_and_model_act_alike(name, normalised, venv, tmp_path):
    model = made(name, venv)
    folder = export.save(model, tmp_path / name, ENV, ARGUMENTS, venv if normalised else None, "train", [0])
    policy = policies.load(folder)
    assert isinstance(policy, LearnedPolicy)
    assert policy.modes == {"history": 1}
    rng, ours, theirs, spread = np.random.default_rng(1), None, None, []
    for t in range(10):
        batch, begun = observations(venv, 64, t), rng.random(64) < 0.2
        if not normalised:
            batch = np.clip(batch, -3.0, 3.0)
        actions, ours = policy.predict(batch, ours, begun)
        seen = venv.normalize_obs(batch) if normalised else batch
        wanted, theirs = model.predict(seen, theirs, begun, deterministic=True)
        assert (actions.shape, actions.dtype) == (wanted.shape, wanted.dtype)
        np.testing.assert_allclose(actions, wanted, atol=1e-6)
        single, _ = policy.predict(batch[0], None if ours is None else tuple(s[:1] for s in ours))
        assert single.shape == (1,)
        spread.append(actions)
    assert np.std(spread) > 0.02


@pytest.mark.parametrize("name", MODELS)
def test_a_rebuilt_model_is_the_one_saved(name, venv, torch, tmp_path):
    model = made(name, venv)
    if name == "SAC":
        model.log_ent_coef.data[:] = -1.5
    folder = export.save(model, tmp_path / name, ENV, ARGUMENTS, venv)
    again = export.normaliser(folder, venv.venv)
    for moments, kept in ((venv.obs_rms, again.obs_rms), (venv.ret_rms, again.ret_rms)):
        for part in ("mean", "var", "count"):
            np.testing.assert_array_equal(getattr(moments, part), getattr(kept, part))
    torch.manual_seed(5)
    rebuilt = export.build(folder, again, device="cpu", learning_rate=1e-4)
    state = rebuilt.policy.state_dict()
    assert state.keys() == model.policy.state_dict().keys()
    for key, value in model.policy.state_dict().items():
        assert torch.equal(state[key], value), key
    assert rebuilt.learning_rate == 1e-4
    if name == "SAC":
        assert rebuilt.log_ent_coef.item() == -1.5
        assert rebuilt.log_ent_coef.requires_grad


def test_training_goes_on_from_a_file(venv, tmp_path):
    model = made("PPO", venv, n_steps=64, batch_size=32, n_epochs=1)
    model.learn(64)
    first = export.save(model, tmp_path / "first", ENV, ARGUMENTS, venv, "train", [0])
    assert LearnedPolicy(first).description.origin.steps == 64
    again = export.normaliser(first, venv.venv)
    rebuilt = export.build(first, again, device="cpu", n_steps=64, batch_size=32, n_epochs=1)
    rebuilt.learn(64)
    second = export.save(rebuilt, tmp_path / "second", ENV, ARGUMENTS, again)
    before, after = files.read(first)[1], files.read(second)[1]
    assert all(not np.array_equal(before[name], after[name]) for name in before)
    batch = observations(again, 16)
    wanted, _ = rebuilt.predict(again.normalize_obs(batch), deterministic=True)
    np.testing.assert_allclose(policies.load(second).predict(batch)[0], wanted, atol=1e-6)


def test_a_policy_that_explored_by_state_acts_and_goes_on(venv, tmp_path):
    few = {"n_steps": 64, "batch_size": 32, "n_epochs": 1}
    model = made("PPO", venv, use_sde=True, **few)
    model.learn(64)
    folder = export.save(model, tmp_path / "policy", ENV, ARGUMENTS, venv)
    batch = observations(venv, 16)
    wanted, _ = model.predict(venv.normalize_obs(batch), deterministic=True)
    np.testing.assert_allclose(policies.load(folder).predict(batch)[0], wanted, atol=1e-6)
    rebuilt = export.build(folder, venv, device="cpu", **few)
    assert rebuilt.use_sde
    rebuilt.learn(64)


def test_a_policy_may_leave_its_training_behind(venv, tmp_path):
    folder = export.save(made("SAC", venv), tmp_path / "lean", ENV, ARGUMENTS, venv, training=False)
    assert {path.name for path in folder.iterdir()} == {"policy.json", WEIGHTS}
    with pytest.raises(ValueError, match=r"unknown file 'training\.safetensors'"):
        export.build(folder, venv)


def test_training_tensors_of_another_model_are_refused(venv, tmp_path):
    kept = {}
    for seed, name in enumerate(("one", "two")):
        folder = export.save(made("PPO", venv, seed), tmp_path / name, ENV, ARGUMENTS, venv)
        kept[name] = files.read(folder, WEIGHTS)[1], files.read(folder, TRAINING)[1]
    values = json.loads((tmp_path / "one" / files.DESCRIPTION).read_text())
    described = {key: value for key, value in values.items() if key not in ("format", "files")}
    mixed = files.write(tmp_path / "mixed", described, kept["one"][0], kept["two"][1])
    with pytest.raises(ValueError, match=r"training\.safetensors: 'layers\.0\.weight' is not the one of"):
        export.build(mixed, venv, device="cpu")
    lacking = {key: value for key, value in kept["one"][1].items() if key != "policy.value_net.bias"}
    cut = files.write(tmp_path / "cut", described, kept["one"][0], lacking)
    with pytest.raises(ValueError, match=r"(?s)training\.safetensors: .*Missing key.*value_net\.bias"):
        export.build(cut, venv, device="cpu")
    other = {**kept["one"][1], "policy.value_net.bias": np.zeros(2, np.float32)}
    with pytest.raises(ValueError, match=r"size mismatch for value_net\.bias"):
        export.build(files.write(tmp_path / "other", described, kept["one"][0], other), venv, device="cpu")


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("PPO", {"activation": "SiLU"}, r"unknown activation 'SiLU'.*ReLU"),
        ("RecurrentPPO", {"policy_kwargs": {"lstm_kwargs": {"dropout": 0.1}, "n_lstm_layers": 2}}, "dropout"),
    ],
)
def test_what_a_file_cannot_hold_is_refused(name, changes, message, venv, torch, tmp_path):
    if "activation" in changes:
        changes = {"policy_kwargs": {"activation_fn": getattr(torch.nn, changes["activation"])}}
    with pytest.raises(ValueError, match=message):
        export.save(made(name, venv, **changes), tmp_path / "no", ENV, ARGUMENTS, venv)
    assert list(tmp_path.iterdir()) == []


def test_state_dependent_exploration_of_sac_is_refused(venv, tmp_path):
    model = made("SAC", venv)
    model.use_sde = True  # its network then ends with a layer of its own
    with pytest.raises(ValueError, match="use_sde = True: what SAC"):
        export.save(model, tmp_path / "no", ENV, ARGUMENTS, venv)


def test_another_environment_or_algorithm_is_refused(venv, tmp_path):
    from stable_baselines3 import A2C

    with pytest.raises(ValueError, match=r"unknown algorithm 'A2C'.*PPO"):
        export.save(A2C("MlpPolicy", venv, device="cpu"), tmp_path / "no", ENV, ARGUMENTS)
    model = made("PPO", venv)
    with pytest.raises(ValueError, match=r"observation has shape \(58,\), .* \(29,\)"):
        export.save(model, tmp_path / "no", ENV, {})


@pytest.mark.slow  # quick: test_learned_policy.py
def test_acting_loads_no_torch(venv, tmp_path):
    folder = export.save(made("PPO", venv), tmp_path / "ppo", ENV, ARGUMENTS, venv)
    code = (
        "import sys, numpy, policies, policies.learned.export\n"
        f"policies.load({str(folder)!r}).predict(numpy.zeros(58, 'f4'))\n"
        "print(sorted({'torch', 'stable_baselines3', 'onnx'} & set(sys.modules)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.endswith("[]\n")
    assert TRAINING in {path.name for path in folder.iterdir()}


def test_the_page_is_true(torch, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "policy_files.md").read_text()
    names = {}
    for example in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(compile(example, "policy_files.md", "exec"), names)
    (printed,) = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    assert capsys.readouterr().out.endswith(printed)
    names["env"].close()


def test_an_environment_is_described_without_pybullet(monkeypatch):
    expected = export.described(ENV, ARGUMENTS)

    def connect():
        raise ModuleNotFoundError("pybullet")

    monkeypatch.setattr(export, "find_spec", lambda name: None)
    monkeypatch.setattr("slipgym.world.scene.connect", connect)
    assert export.described(ENV, ARGUMENTS) == expected
