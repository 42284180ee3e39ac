"""PPO of rsl-rl: what its actor sees, the policy that it leaves behind, the start from one, its stages."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
pytest.importorskip("rsl_rl")
import policies
from policies.training import checkpoints, files, folder, model, run, vector
from policies.training.adapter import make_vec_env
from policies.training.files import checked
from policies.training.imitation.config import Imitation
from policies.training.imitation.run import imitate
from policies.training.privileged_ppo import PrivilegedPPO
from slipgym.envs.observation import DEVIATION_COLUMNS

torch = pytest.importorskip("torch")


@pytest.fixture(scope="module", params=[0, 5])
def trained(request, small, tmp_path_factory):
    """A run and its configuration, without and with a memory; it reads a derived column beyond the clip."""
    chosen = {"n_steps": 16, "n_epochs": 1, "n_minibatches": 1, "memory": request.param, "net_arch": [8, 6]}
    error = {"error": {"measured_slip_y": -2000.0, "reference_position": -2000.0}}
    config = small(algorithm="privileged_ppo", privileged_ppo=chosen, derived=error)
    path = tmp_path_factory.mktemp("run") / "run"
    folder.begin(path, config, 0)
    run.train(path, progress=False)
    return config, path


def played(config, act, steps=12):
    """Actions (steps, n, m) in the held-out environments; `act` gets observations by group."""
    envs = vector.make(config, 7, 2)
    observations, starts, found = envs.reset(), np.ones(2, bool), []
    for _ in range(steps):
        found.append(act(observations, starts))
        observations, _, starts, _ = envs.step(found[-1])
    envs.close()
    return np.array(found)


def of_file(path):
    """How the policy in a folder acts."""
    policy, memory = policies.load(path), [None]

    def act(observations, starts):
        actions, memory[0] = policy.predict(observations["policy"], memory[0], starts)
        return actions

    return act


def acting(learner):
    """How a learner acts, memory included."""
    memory = [None]

    def act(observations, starts):
        actions, memory[0] = learner.predict(observations, memory[0], starts)
        return actions

    return act


def test_the_policy_of_a_run_acts_as_its_best_learner(trained):
    config, path = trained
    by_file = played(config, of_file(path / "policy"))
    learner = model.begin(config, 0)
    model.set_parameters(learner, checkpoints.read(checkpoints.best(path))["learner"])
    np.testing.assert_allclose(by_file, played(config, acting(learner)), atol=2e-5)
    learner.get_env().close()


def test_a_policy_says_how_many_steps_it_has_learned_from(trained):
    """Those of its checkpoint, which may be fewer than the run's."""
    _, path = trained
    found = folder.result(path)
    assert policies.load(path / "policy").description.origin.steps == found["best"]["steps"]


def test_a_learner_starts_as_the_policy_that_it_is_given(trained):
    config, path = trained
    values = config.model_dump()
    values["privileged_ppo"]["start"] = str(path / "policy")
    learner = model.begin(checked(values, "test"), 1)
    by_file = played(config, of_file(path / "policy"))
    np.testing.assert_allclose(played(config, acting(learner)), by_file, atol=2e-5)
    learner.get_env().close()


@pytest.mark.quick_cases("none-flat")
@pytest.mark.parametrize(("source", "mode"), [("none", "flat"), ("estimated", "deviations")])
def test_a_learner_starts_as_an_imitated_network(small, tmp_path, source, mode):
    """Its columns have scales from micrometres to newtons."""
    environment = {
        **small().environment.model_dump(mode="json"),
        "friction_source": source,
        "observation_mode": mode,
        "action_mode": "log_grip_force",
        "load_columns": True,
    }
    sizes = {"memory": 5, "layers": [6], "rounds": 1, "rows": 8, "updates": 3, "batch": 4, "held_out": 0}
    folder, _ = imitate(
        Imitation.model_validate({"task": "LinearSlip", "environment": environment, **sizes}), tmp_path
    )
    chosen = {"memory": 5, "net_arch": [6], "start": str(folder / "policy"), "n_minibatches": 1}
    config = small(algorithm="privileged_ppo", privileged_ppo=chosen, environment=environment)
    learner = model.begin(config, 1)
    by_file = played(config, of_file(folder / "policy"))
    np.testing.assert_allclose(played(config, acting(learner)), by_file, atol=2e-5)
    learner.get_env().close()


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"privileged_ppo": {"memory": 3}}, "needs the network"),
        ({"task": "Hinge"}, "is a policy for slipgym/LinearSlip-v0"),
        ({"environment": {"load_columns": True}}, "does not fit the observation"),
    ],
)
def test_a_policy_that_does_not_fit_is_refused(trained, changes, named):
    config, path = trained
    values = config.model_dump()
    values["privileged_ppo"]["start"] = str(path / "policy")
    if "task" in changes:
        values["environment"]["config"], values["derived"] = {}, {}
    for name, value in changes.items():
        values[name] = {**values[name], **value} if isinstance(value, dict) else value
    with pytest.raises(ValueError, match=named):
        model.begin(checked(values, "test"), 1)


def test_the_actor_does_not_read_the_privileged_group(trained):
    config, _ = trained
    learner = model.begin(config, 0)
    act, rng = acting(learner), np.random.default_rng(0)

    def blind(observations, starts):
        other = rng.normal(size=observations["privileged"].shape).astype(np.float32)
        return act({**observations, "privileged": other}, starts)

    seen = played(config, acting(learner))
    np.testing.assert_array_equal(played(config, blind), seen)
    learner.get_env().close()


@pytest.mark.parametrize("mode", ["dict", "deviations_dict"])
def test_a_plain_actor_is_not_shown_the_truth(mode):
    with pytest.raises(ValueError, match=f"'{mode}' would show the true friction to the actor"):
        make_vec_env("Carry", 2, observation_mode=mode)


def test_the_actor_may_read_the_deviations_of_the_estimates(small):
    """The group of the critic stays what it was."""
    shown, seen = {}, small().environment.model_dump()
    for mode in ("flat", "deviations"):
        config = small(algorithm="privileged_ppo", environment={**seen, "observation_mode": mode})
        envs = model.begin(config, 0).get_env()
        shown[mode] = envs.observation_space.spaces
        envs.close()
    assert shown["deviations"]["policy"].shape[0] == shown["flat"]["policy"].shape[0] + len(DEVIATION_COLUMNS)
    assert shown["deviations"]["privileged"] == shown["flat"]["privileged"]


@pytest.mark.parametrize("name", ["carry", "Carry", "slipgym/Carry-v0"])
def test_a_task_has_any_spelling(name):
    envs = make_vec_env(name, 2, 0, threads=1)
    assert envs.reset().shape[0] == 2
    envs.close()


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"engine": "bullet"}, "needs engine 'planar'"),
        ({"environment": {"observation_mode": "sensor"}}, "observation_mode 'flat' or 'deviations'"),
        ({"privileged_ppo": {"n_minibatches": 99}}, "must not exceed 64"),
        ({"privileged_ppo": {"curriculum": {"stages": [{"tasks": {"linear_slip": {"tol": 1}}}]}}}, "tol"),
        ({"privileged_ppo": {"memory": -1}}, "whole number >= 0"),
    ],
)
def test_a_wrong_configuration_says_what_is_wrong(small, changes, named):
    with pytest.raises(ValueError, match=named):
        small(algorithm="privileged_ppo", **changes)


def test_the_configurations_from_nothing_are_read():
    found = [name for name in files.names() if name.endswith("_scratch")]
    assert len(found) == 9
    for name in found:
        assert files.load(name).algorithm == "privileged_ppo"


def test_losses_and_what_training_solves_are_recorded(trained):
    accumulator = pytest.importorskip("tensorboard.backend.event_processing.event_accumulator")
    events = accumulator.EventAccumulator(str(trained[1] / "tensorboard"))
    events.Reload()
    wanted = {f"train/{name}" for name in ("value", "surrogate", "entropy", "solved", "stage")}
    assert wanted <= set(events.Tags()["scalars"])


@pytest.mark.parametrize(
    ("horizon", "shortest", "longest"), [({}, 50.0, 300.0), ({"memory_horizon": 2.0}, 2.0, 2.0)]
)
def test_a_new_actor_remembers_from_the_start(small, horizon, shortest, longest):
    """Its units hold what they know for up to 300 steps, or as configured."""
    chosen = {"memory": 64, "net_arch": [8], "n_minibatches": 1, **horizon}
    config = small(algorithm="privileged_ppo", privileged_ppo=chosen)
    actor: Any = PrivilegedPPO(config, 0).ppo.actor
    layer = actor.rnn.rnn
    with torch.no_grad():
        bias = layer.bias_ih_l0 + layer.bias_hh_l0
        written, kept, *_ = (torch.sigmoid(part) for part in bias.chunk(4))
    steps = 1.0 / (1.0 - kept)
    assert 1.0 < steps.min() <= shortest
    assert 0.66 * longest < steps.max() <= longest
    torch.testing.assert_close(written, 1.0 - kept)


def test_options_of_reset_vary_in_training(small, tmp_path):
    folder.begin(tmp_path / "run", small(algorithm="privileged_ppo", vary={"distance": [0.02, 0.03]}), 0)
    assert run.train(tmp_path / "run", progress=False)["ended"] == "budget"
