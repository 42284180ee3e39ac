"""`slipgym evaluate --policy` runs a policy where it was trained."""

import numpy as np
import pytest
from typer.testing import CliRunner

import policies
from policies.commands.evaluate import app
from policies.commands.several import environment_arguments
from policies.evaluation.one_policy import environment_of, episodes
from policies.learned import pretrained
from policies.training import seeds

SHORT = {"config": {"tasks": {"hold": {"duration": 0.5}}}}


def evaluated(*words):
    return CliRunner().invoke(app, ["--policy", *words], catch_exceptions=False)


def test_it_says_how_the_episodes_went(policy_folder):
    folder = str(policy_folder(environment={"arguments": {**SHORT, "friction_source": "estimated"}}))
    found = list(episodes(folder, 3, first=5))
    assert found == list(episodes(folder, 5, first=3))[2:]
    said = evaluated(folder, "--trials", "3", "--seed", "5").output
    solved, dropped = sum(one.success for one in found), sum(one.dropped for one in found)
    assert f"{folder}: solved {solved} of 3, dropped {dropped}; means: reward " in said
    assert f"time {sum(one.time for one in found) / 3:.2f} s" in said


def test_the_episodes_are_held_out(monkeypatch):
    from slipgym.envs import HoldEnv

    used, reset = [], HoldEnv.reset
    monkeypatch.setattr(
        HoldEnv, "reset", lambda env, *, seed=None, options=None: used.append(seed) or reset(env, seed=seed)
    )
    list(episodes("hold", 2, first=7, changes=SHORT))
    assert used == [seeds.held_out(7), seeds.held_out(8)]


class Alone:
    """A policy that forgets the state."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros(1, np.float32)


class Failing(Alone):
    """A policy with a fault of its own."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros(3) + np.zeros(2), None


@pytest.mark.parametrize(
    ("policy", "error", "message"),
    [
        (Alone, TypeError, "Alone.predict must return the action and the next state, got array"),
        (Failing, ValueError, "broadcast"),
    ],
)
def test_an_error_of_a_policy_that_acts_is_no_fault_of_the_command_line(policy, error, message):
    words = "--task", "hold", "--trials", "1", "--set", "engine=planar"
    with pytest.raises(error, match=message):
        evaluated(f"{__name__}:{policy.__name__}", *words)


def test_the_environment_is_that_of_the_training_unless_told_otherwise(policy_folder):
    arguments = {"friction_source": "true", "randomization": "train"}
    folder = policy_folder(environment={"arguments": arguments})
    assert environment_of("it", policies.load(folder), None) == ("slipgym/Hold-v0", arguments)
    (one,), (other,) = (
        list(episodes(folder, 1, changes={**SHORT, "randomization": preset})) for preset in ("none", "train")
    )
    assert one.reward != other.reward


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["hold", "--task", "Hinge"], "task = 'Hinge': the policy 'hold' is for Hold"),
        (["constant_force"], "the policy 'constant_force' serves every task: name a task"),
        (["nowhere"], "no policy at 'nowhere'"),
        (["hold", "--set", "materiall=wood"], "did you mean 'material'"),
        (["hold", "--set", "material"], "must be name=value"),
        (["hold", "--trials", "0"], "--trials"),
        (["{folder}", "--task", "LinearSlip"], "was trained in slipgym/Hold-v0"),
        (["{folder}", "--set", "friction_source=none"], "the policy was trained for another observation"),
        (["{folder}", "--set", "frame_skip=2"], "120 steps per second, here are 60"),
    ],
)
def test_mistakes_are_explained(policy_folder, arguments, message):
    folder = str(policy_folder())
    done = evaluated(*[argument.format(folder=folder) for argument in arguments])
    assert done.exit_code == 2
    assert message in " ".join(done.output.replace("│", " ").split())


@pytest.mark.parametrize("name", pretrained.folders())
@pytest.mark.quick_cases("hold_scratch", "carry_scratch")
def test_what_comes_with_slipgym_acts_in_the_environment_of_its_training(name):
    (outcome,) = episodes(name, 1)
    assert outcome.time > 0.0


def test_settings_of_the_environment_may_be_dotted_as_in_a_training():
    texts = ["environment.config.tasks.hold.tolerance=0.001", "config.tasks.hold.duration=2.0", "level=hard"]
    assert environment_arguments(texts) == {
        "config": {"tasks": {"hold": {"tolerance": 0.001, "duration": 2.0}}},
        "level": "hard",
    }
