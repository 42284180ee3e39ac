"""Zips of Stable-Baselines3 become folders of policies; nothing in them is executed."""

import json
import pickle
import zipfile

import gymnasium as gym
import numpy as np
import pytest
from typer.testing import CliRunner

import slipgym  # noqa: F401
from policies.commands.import_policy import app
from policies.learned import LearnedPolicy
from policies.learned.sb3_zip import import_zip

ENV = "slipgym/Hold-v0"
ARGUMENTS = {"friction_source": "true", "history": 1, "engine": "planar"}
MODELS = {
    "PPO": ("stable_baselines3", "MlpPolicy", {"net_arch": {"pi": [32, 16], "vf": [24]}}),
    "SAC": ("stable_baselines3", "MlpPolicy", {"net_arch": [32]}),
    "TQC": ("sb3_contrib", "MlpPolicy", {"net_arch": [32, 32], "n_quantiles": 7}),
    "RecurrentPPO": ("sb3_contrib", "MlpLstmPolicy", {"net_arch": [16], "lstm_hidden_size": 12}),
}


def model(name, **policy):
    torch = pytest.importorskip("torch")
    module, kind, keywords = MODELS[name]
    module = pytest.importorskip(module)
    torch.set_num_threads(1)
    env = gym.make(ENV, disable_env_checker=True, **ARGUMENTS)
    return getattr(module, name)(kind, env, policy_kwargs={**keywords, **policy}, seed=0, device="cpu")


@pytest.fixture
def zipped(tmp_path):
    path = tmp_path / "model.zip"
    model("PPO").save(path)
    return path


def rewritten(source, target, **members):
    """A copy of a zip with other contents of some members; None leaves one out."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = members.get(name.replace(".", "_"), old.read(name))
            if content is not None:
                new.writestr(name, content)
    return target


@pytest.mark.parametrize("name", MODELS)
def test_model_and_folder_act_alike(name, tmp_path):
    torch = pytest.importorskip("torch")
    made = model(name, activation_fn=torch.nn.ELU)
    made.save(tmp_path / "model.zip")
    policy = LearnedPolicy(import_zip(tmp_path / "model.zip", tmp_path / "policy", ENV, ARGUMENTS))
    rows = np.stack([made.observation_space.sample() for _ in range(6)]).clip(-3.0, 3.0)
    state, theirs = None, None
    start = np.ones(6, bool)
    for _ in range(3):
        ours, state = policy.predict(rows, state, start)
        wanted, theirs = made.predict(rows, theirs, start, deterministic=True)
        np.testing.assert_allclose(ours, wanted, atol=2e-6)
        start = np.zeros(6, bool)


def test_pickles_in_the_zip_are_not_executed(zipped, tmp_path):
    class Evil:
        def __reduce__(self):
            return (exec, (f"open({str(tmp_path / 'executed')!r}, 'w')",))

    data = json.loads(zipfile.ZipFile(zipped).read("data"))
    import base64

    data["policy_class"][":serialized:"] = base64.b64encode(pickle.dumps(Evil())).decode()
    changed = rewritten(zipped, tmp_path / "evil.zip", data=json.dumps(data).encode())
    import_zip(changed, tmp_path / "policy", ENV, ARGUMENTS)
    bad = rewritten(zipped, tmp_path / "worse.zip", policy_pth=pickle.dumps(Evil()))
    with pytest.raises(ValueError, match="holds no plain tensors"):
        import_zip(bad, tmp_path / "other", ENV, ARGUMENTS)
    assert not (tmp_path / "executed").exists()
    assert not (tmp_path / "other").exists()


def test_what_does_not_fit_is_refused(zipped, tmp_path):
    target = tmp_path / "policy"
    for arguments, said in (({"engine": "planar"}, "observation has"), ({"friction_sorce": "true"}, "sorce")):
        with pytest.raises((ValueError, TypeError), match=said):
            import_zip(zipped, target, ENV, arguments)
    data = json.loads(zipfile.ZipFile(zipped).read("data"))
    for change, said in (
        ({"data": None}, "no 'data'"),
        ({"policy_pth": None}, "no 'policy.pth'"),
        ({"data": b"["}, "no JSON"),
        ({"data": b"[]"}, "no mapping"),
        ({"data": json.dumps({**data, "num_timesteps": -1}).encode()}, "num_timesteps = -1"),
        ({"data": json.dumps({**data, "policy_kwargs": {"activation_fn": "Swish"}}).encode()}, "Swish"),
    ):
        with pytest.raises(ValueError, match=said):
            import_zip(rewritten(zipped, tmp_path / "bad.zip", **change), target, ENV, ARGUMENTS)
    (tmp_path / "text").write_text("no zip")
    with pytest.raises(ValueError, match="no zip"):
        import_zip(tmp_path / "text", target, ENV, ARGUMENTS)
    assert not target.exists()


def test_the_command_line(zipped, tmp_path):
    call = [str(zipped), str(tmp_path / "policy"), "--environment", ENV, "--set"]
    done = CliRunner().invoke(app, [*call, "friction_source=true", "history=1", "engine=planar"])
    assert done.exit_code == 0, done.output
    assert LearnedPolicy(tmp_path / "policy").modes == {"history": 1}
    missing = CliRunner().invoke(app, [str(tmp_path / "none.zip"), "x", "--environment", ENV])
    assert missing.exit_code == 2


def test_the_command_takes_a_task_and_refuses_other_environments(zipped, tmp_path):
    settings = ["--set", "friction_source=true", "history=1"]
    done = CliRunner().invoke(app, [str(zipped), str(tmp_path / "p"), "--environment", "hold", *settings])
    assert done.exit_code == 0, done.stderr
    assert LearnedPolicy(tmp_path / "p").description.environment.id == ENV
    wrong = CliRunner().invoke(app, [str(zipped), str(tmp_path / "q"), "--environment", "hld"])
    assert wrong.exit_code == 2
    assert "'hold'" in wrong.output
