"""Imitation of the controller that knows the true friction."""

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.stepping import batch_steps
from policies.training.imitation.command import configured, imitated
from policies.training.imitation.config import Imitation, read

torch = pytest.importorskip("torch")
from policies.learned import LearnedPolicy  # noqa: E402
from policies.learned.description import Column  # noqa: E402
from policies.learned.policy import Network  # noqa: E402
from policies.training.imitation import run  # noqa: E402
from policies.training.imitation.episodes import Scene, demonstrate  # noqa: E402
from policies.training.imitation.run import imitate  # noqa: E402
from policies.training.imitation.student import NORMALISATION, Student, network_of  # noqa: E402

SHORT = {"tasks": {"linear_slip": {"duration": 0.3, "settle": 0.1, "hold": 0.05}}}
SMALL = {
    "task": "LinearSlip",
    "environment": {"friction_source": "none", "frame_skip": 2, "randomization": "train", "config": SHORT},
    "memory": 8,
    "layers": [8],
    "rounds": 2,
    "rows": 8,
    "updates": 6,
    "batch": 4,
    "held_out": 8,
}


@pytest.mark.parametrize(("memory", "squash"), [(0, False), (5, False), (5, True)])
def test_the_network_that_learns_is_the_one_that_acts(memory, squash):
    config = Imitation.model_validate({**SMALL, "memory": memory, "squash": squash})
    rng = np.random.default_rng(0)
    components = [
        Column(name=name, low=-1.0, high=1.0, unit="-") for name in ("grip_force", "wrist_pitch_rate")
    ]
    student = Student(config, rng.normal(size=7), rng.uniform(0.5, 2.0, 7), components)
    observations = rng.normal(size=(9, 3, 7)).astype(np.float32)
    learns = student(torch.from_numpy(observations)).detach().numpy()
    acts = Network(network_of(config), NORMALISATION, student.tensors())
    zeros = np.zeros((3, 1, memory), np.float32)
    state = (zeros, zeros.copy()) if memory else None
    for t, seen in enumerate(observations):
        actions, state = acts.forward(seen, state)
        np.testing.assert_allclose(actions, np.clip(learns[t], -1.0, 1.0), atol=2e-6)


def test_the_controller_acts_as_in_an_environment_that_shows_the_true_friction():
    config = Imitation.model_validate(SMALL)
    scene = Scene(config, 8)
    found = demonstrate(scene, None, np.zeros(8, bool), seed=3)
    scene.close()
    arguments = {
        **config.environment.model_dump(mode="json"),
        "friction_source": "true",
        "action_mode": "grip_force",
    }
    envs = gym.make_vec("slipgym:slipgym/LinearSlip-v0", 8, "vector_entry_point", **arguments).unwrapped
    policy = policies.make("linear_slip", config=_at_sixty())
    observations, _ = envs.reset(seed=3)
    for k, step in enumerate(batch_steps(envs, policy, observations)):
        width = found.observations.shape[2]
        if k + 1 < len(found.observations):
            running = step.running & ~step.ended
            np.testing.assert_array_equal(
                found.observations[k + 1][running], step.observations[running][:, :width]
            )
    assert found.lengths.max() == k + 1
    envs.close()


@pytest.mark.parametrize("teacher", ["estimate", "revealed"])
def test_a_teacher_that_has_to_find_friction_out(teacher):
    config = Imitation.model_validate({**SMALL, "teacher": teacher})
    scene = Scene(config, 4)
    observations, infos = scene.envs.reset(seed=3)
    names = [column.name for column in scene.envs.columns]
    bare = names.index("mu_s")
    assert scene.seen(observations).shape == (4, bare)
    observations[:2, names.index("confidence_mu_s")] = 0.9
    observations[2:, names.index("confidence_mu_s")] = 0.0
    taught = scene.taught(observations, infos["true"])
    scene.close()
    if teacher == "estimate":
        np.testing.assert_array_equal(taught, observations)
    else:
        np.testing.assert_array_equal(taught[:2, bare], infos["true"][:2, 0].astype(np.float32))
        np.testing.assert_array_equal(taught[2:, bare], observations[2:, bare])
        assert taught[0, bare + 3] == 1.0
        assert taught[2, bare + 3] == 0.0


def test_units_of_the_memory_forget_at_different_rates():
    components = [Column(name="grip_force", low=-1.0, high=1.0, unit="-")]
    config = Imitation.model_validate({**SMALL, "memory": 64, "squash": True})
    student = Student(config, np.zeros(3), np.ones(3), components)
    bias = student.tensors()["memory.0.hidden_bias"].reshape(4, 64)
    np.testing.assert_array_equal(bias[0], -bias[1])
    assert bias[1].min() >= 0.0
    assert bias[1].max() > 4.0
    assert np.abs(student(torch.full((2, 1, 3), 1e3)).detach().numpy()).max() <= 1.0


def _at_sixty():
    from policies.controllers.rate import at_rate

    return at_rate(60, SHORT)


@pytest.mark.parametrize("source", ["none", "estimated"])
def test_a_policy_is_written_and_acts(tmp_path, source):
    config = configured(
        "recurrent", "linear_slip", {"friction_source": source, "randomization": None}, _assignments()
    )
    folder, solved = imitate(config, tmp_path, seed=1, command="test")
    again, _ = imitate(config, tmp_path / "again", seed=1, command="test")
    assert 0.0 <= solved <= 1.0
    weights = [(each / "policy" / "weights.safetensors").read_bytes() for each in (folder, again)]
    assert weights[0] == weights[1]
    policy = LearnedPolicy(folder / "policy")
    assert policy.description.origin.algorithm == "DAgger"
    env = gym.make(
        "slipgym:slipgym/LinearSlip-v0", engine="planar", **policy.description.environment.arguments
    )
    policy.check(env)
    observation, _ = env.reset(seed=0)
    action, state = policy.predict(observation)
    assert env.action_space.contains(action)
    assert state is not None
    with pytest.raises(FileExistsError, match="already"):
        imitate(config, tmp_path, seed=1)


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
@pytest.mark.parametrize("stage", ["demonstrate", "judged", "write"])
def test_a_run_that_is_broken_off_keeps_the_policy_of_its_last_round(tmp_path, monkeypatch, stage, error):
    config = Imitation.model_validate({**SMALL, "rounds": 3})
    module, name = (run, stage) if stage != "write" else (run.files, "write")
    real, calls = getattr(module, name), []

    def fail(*given):
        calls.append(given)
        if stage == "judged" or len(calls) == 3:
            raise error("planted")
        return real(*given)

    monkeypatch.setattr(module, name, fail)
    with pytest.raises(error, match="planted"):
        imitate(config, tmp_path)
    folder = tmp_path / "linear_slip_none_0"
    rounds = 3 if stage == "judged" else 2
    assert not (folder / "policy").exists()
    assert [path.name for path in (folder / "unfinished").iterdir()] == [f"round_{rounds}"]
    policy = LearnedPolicy(folder / "unfinished" / f"round_{rounds}")
    assert policy.description.origin.steps > 0
    assert len((folder / "curve.csv").read_text().splitlines()) == 1 + rounds
    with pytest.raises(FileExistsError, match="not finished, its policy is in unfinished"):
        imitate(config, tmp_path)


def test_all_seeds_are_looked_at_before_the_first_is_trained(tmp_path, monkeypatch):
    monkeypatch.setattr(run, "run", lambda *_, **__: pytest.fail("it trained"))
    (tmp_path / "linear_slip_none_7").mkdir()
    with pytest.raises(FileExistsError, match="linear_slip_none_7 is there already"):
        list(imitated(Imitation.model_validate(SMALL), [0, 7], tmp_path))


def _assignments():
    small = {key: SMALL[key] for key in ("memory", "rounds", "rows", "updates", "batch", "held_out")}
    return [f"{key}={value}" for key, value in small.items()] + ["layers=[8]", f"environment.config={SHORT}"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"environment": {"history": 2}}, "history must be 0"),
        ({"environment": {"action_mode": "grip_force"}}, "must be null, the controller"),
        ({"rows": 4096, "rounds": 8}, "at most 16384"),
        ({"task": "Linear"}, "unknown task"),
        ({"teacher": "estimate", "environment": {"friction_source": "true"}}, "none or estimated"),
        ({"memory": -1}, "memory"),
    ],
)
def test_what_cannot_be_imitated_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        read({**SMALL, **change})


def test_a_logarithmic_network_is_taught_the_same_grip():
    """The controller's linear action and what the network is taught command the same force."""
    small = {**SMALL, "environment": {**SMALL.get("environment", {}), "action_mode": "log_grip_force"}}
    scene = Scene(Imitation.model_validate(small), 2)
    linear = np.array([[-1.0], [-0.3], [0.0], [0.7], [1.0]], np.float32)
    low, high = np.exp([scene.envs.action_columns[0].low, scene.envs.action_columns[0].high])
    wanted = low + 0.5 * (linear + 1.0) * (high - low)
    found = low * (high / low) ** (0.5 * (scene.acted(linear) + 1.0))
    np.testing.assert_allclose(found, wanted, rtol=1e-5)
    scene.close()


@pytest.mark.parametrize("task", ["hold", "linear_slip"])
def test_an_observation_mode_that_the_controller_does_not_read_is_refused(task):
    own = policies.modes(policies.make(task)).get("observation_mode", "flat")
    other = "flat" if own == "deviations" else "deviations"
    given = {"friction_source": "estimated"}
    with pytest.raises(ValueError, match=f"observation_mode = '{other}': .* needs '{own}'"):
        configured("hard_start", task, given, [f"environment.observation_mode={other}"])
    assert configured("hard_start", task, given, [f"environment.observation_mode={own}"])
    assert configured("hard_start", task, {}, [f"environment.observation_mode={other}"])  # sensors alone
