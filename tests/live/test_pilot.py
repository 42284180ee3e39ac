"""A policy behind live estimates acts as it does in its environment, and holds firmly when anything fails."""

import json
import shutil

import gymnasium as gym
import numpy as np
import pytest

import policies
from estimator.live import Live
from estimator.live.session import Session
from lab.live_streams import readings
from policies.learned.pretrained import folders
from policies.live import AGAIN, PolicyPilot
from slipgym.tasks import find

TIMED = ("time_left", "violated")
WRIST = ("wrist_velocity_x", "wrist_velocity_z", "wrist_pitch_rate")
REFERENCE = ("reference_position", "reference_velocity", "reference_acceleration")
OWN = {
    "Hold": (*WRIST, *TIMED),
    "LinearSlip": (*REFERENCE, "distance", *TIMED),
    "PlanarSlip": ("target_x", "target_y", "target_theta", *TIMED, "wrist_pitch_rate", "wrist_pitch"),
}
"""Columns of a task that no sensor reads."""
WRENCH, TWIST = ("f_x", "f_y", "f_n", "tau"), ("v_x", "v_y", "omega")


def session(policy="hold", fingers=2, **arguments):
    live = Live("rls", fingers=fingers)
    return Session(live, PolicyPilot(policy, live, **arguments))


def play(found, seconds=1.0, start=0.0, fingers=(1, 2)):
    """All commands while fingers deliver."""
    commands = []
    for kind, t, values in readings(seconds, width=4):
        for finger in fingers:
            answers = found.give({"finger": finger, "t": start + t, kind: values}, start + t)
            commands += [each for each in answers + found.tick(start + t) if "command" in each]
    return commands


def in_environment(task, policy, steps=120):
    """An episode at 120 Hz: observations by name, and the grip force that followed each."""
    actor = policies.load(policy)
    modes = {"observation_mode": "deviations", **policies.modes(actor)}
    if hasattr(actor, "description"):
        blind = "mu_c" not in actor.names
        modes = {"friction_source": "none" if blind else "estimated", **policies.modes(actor)}
    every = modes.pop("frame_skip", 1)  # readings come at 120 Hz, whatever the policy's rate
    env = gym.make(f"slipgym:slipgym/{task}-v0", estimator="rls", **modes)
    observation, _ = env.reset(seed=3)
    inner, state, frames, forces = env.unwrapped, None, [], []
    names = [column.name for column in inner.columns]
    for k in range(steps):
        frames.append(dict(zip(names, observation.tolist(), strict=True)))
        if k % every == 0:
            action, state = actor.predict(observation, state)
        observation, *_ = env.step(action)
        forces.append(float(inner.simulation.commands[0, 0]))
    env.close()
    return frames, forces[::every]


@pytest.mark.parametrize(
    ("task", "policy"),
    [
        ("Hold", "hold"),
        ("Hold", "hold_memory"),
        ("Hold", "hold_scratch"),
        ("LinearSlip", "linear_slip"),
        ("LinearSlip", "linear_slip_scratch"),
        ("PlanarSlip", "planar_slip"),
    ],
)
def test_it_commands_what_the_policy_does_in_its_environment(task, policy):
    frames, forces = in_environment(task, policy)
    own = [{name: frame[name] for name in OWN[task]} for frame in frames]
    live = Live("rls", rates=(120.0, 120.0), lateness=0.0)
    pilot = PolicyPilot(policy, live, task, own[0], firm=frames[0]["commanded_force"])
    found, commands = Session(live, pilot), []
    for k, frame in enumerate(frames):
        for finger in (1, 2):
            for kind, parts in (("wrench", WRENCH), ("twist", TWIST)):
                values = [frame[f"{name}_{finger}"] for name in parts]
                answers = found.give({"finger": finger, "t": k / 120.0, kind: values}, k / 120.0)
                commands += [each for each in answers if "command" in each]
        assert found.give({"columns": own[k]}) == []  # the frame is estimated from when the next one begins
    given = [each["grip_force"] for each in commands]
    assert len(forces) - len(given) <= 1
    assert {each["status"] for each in commands} == {"ok"}
    np.testing.assert_allclose(given, forces[: len(given)], rtol=1e-3)


def test_the_grip_is_firm_until_data_come_and_when_any_sensor_stops():
    found = session()
    (first,) = found.tick(0.0)
    assert first["grip_force"] == 25.0
    assert first["status"].startswith("firm: silent: force 1, velocity 1, force 2, velocity 2")
    commands = play(found, start=10.0)
    assert commands[-1]["status"] == "ok"
    assert commands[-1]["grip_force"] < 20.0
    assert found.tick(11.05) == []
    (held,) = found.tick(11.12)
    assert held["status"].startswith("firm: silent")
    assert held["grip_force"] == 25.0
    assert found.tick(11.12 + 0.5 * AGAIN) == []
    assert len(found.tick(11.12 + 1.1 * AGAIN)) == 1
    assert play(found, start=12.0)[-1]["status"] == "ok"


@pytest.mark.parametrize("silent", [("wrench", 1), ("twist", 2)])
def test_one_silent_sensor_is_enough(silent):
    found = session()
    play(found)
    commands = []
    for kind, t, values in readings(0.5, width=4):
        for finger in (1, 2):
            if (kind, finger) != silent:
                commands += found.give({"finger": finger, "t": 1.0 + t, kind: values}, 1.0 + t)
        commands += found.tick(1.0 + t)
    commands = [each for each in commands if "command" in each]
    name = f"{'force' if silent[0] == 'wrench' else 'velocity'} {silent[1]}"
    assert commands[-1]["status"] == f"firm: silent: {name}"
    assert commands[-1]["grip_force"] == 25.0


def test_readings_that_pair_to_nothing_are_as_good_as_none():
    found = session(fingers=1)
    play(found, fingers=(1,))
    commands = []
    for k in range(10):  # neither sensor is silent, but no force is near a velocity
        for t, reading in (
            (1.0 + 0.08 * k, {"wrench": [1.0, 0, 5.0, 0]}),
            (1.04 + 0.08 * k, {"twist": [0, 0, 0]}),
        ):
            commands += found.give({"finger": 1, "t": t, **reading}, t) + found.tick(t)
    assert [each["status"] for each in commands if "command" in each][-1] == "firm: no estimates"
    assert found.live.counts["velocity 1"]["no_force"] > 5


class Failing:
    """A policy that fails in the way and at the step it is told."""

    action_mode = "grip_force"

    def __init__(self, how="raise", at=50):
        self.how, self.at, self.steps = how, at, 0

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        self.steps += 1
        if self.steps != self.at:
            return np.zeros(1, np.float32), state
        if self.how == "raise":
            raise KeyError("a fault of its own")
        return np.full(1, np.nan, np.float32), state


@pytest.mark.parametrize("how", ["raise", "nan"])
def test_a_policy_that_fails_makes_the_grip_firm(how):
    found = session("tests.live.test_pilot:Failing", how=how)
    commands = play(found)
    (bad,) = [each for each in commands[1:] if each["status"] != "ok"]
    assert bad["status"].startswith("firm: the policy")
    assert bad["grip_force"] == 25.0
    assert commands[-1]["status"] == "ok"


def test_the_firm_grip_is_never_weaker_than_the_last_one():
    found = session("constant_force", firm=2.0)
    assert play(found)[-1]["grip_force"] > 2.0
    (held,) = found.tick(5.0)
    assert held["grip_force"] > 2.0


@pytest.mark.parametrize(
    ("policy", "arguments", "says"),
    [
        ("hold_scratch", {}, "time_left"),
        ("linear_slip", {}, "reference_position"),
        ("hold", {"columns": {"time_lef": 1.0}}, "time_left"),
        ("hold", {"columns": {"time_left": float("nan")}}, "finite"),
        ("hold", {"columns": {"time_left": "soon"}}, "finite"),
        ("hold", {"firm": 1000.0}, "firm"),
        ("hold", {"timeout": 0.001}, "timeout"),
        ("no_such", {}, "no_such"),
    ],
)
def test_what_cannot_work_is_refused_at_the_start(policy, arguments, says):
    with pytest.raises((ValueError, FileNotFoundError), match=says):
        session(policy, **arguments)


def test_velocities_at_another_rate_than_the_policys_are_refused():
    with pytest.raises(ValueError, match="120 Hz"):
        PolicyPilot("hold", Live("rls", rates=(1000.0, 100.0)))


def test_messages_set_columns_that_no_sensor_reads():
    found = session("hold_scratch", columns={"time_left": 4.0})
    assert found.give({"columns": {"time_left": 3.0}}, 0.0) == []
    (refused,) = found.give({"columns": {"time_left": None}}, 0.0)
    assert "finite" in refused["error"]
    assert found.pilot._given["time_left"] == 3.0


def test_one_finger_with_sensors_stands_for_both():
    assert play(session(fingers=1), fingers=(1,))[-1]["status"] == "ok"


@pytest.mark.parametrize("value", ["NaN", "null", "true", '"1"', "[1]", "1e999", "9" * 400])
def test_no_value_of_a_column_breaks_a_session(value):
    found = session("hold")
    (refused,) = found.take(f'{{"columns": {{"time_left": {value}}}}}', 0.0)
    assert "finite" in refused["error"]


def test_columns_that_were_given_stay_when_the_grip_was_firm():
    found = session("hold", columns={"wrist_velocity_x": 0.1})
    play(found)
    found.tick(5.0)
    assert found.pilot._given["wrist_velocity_x"] == 0.1


@pytest.mark.parametrize("rate", [100.0, 50.0, 90.0])
def test_a_rate_that_is_no_multiple_is_refused_with_those_that_are(rate):
    live = Live("rls", rates=(1000.0, rate))
    with pytest.raises(ValueError, match=rf"60, 120, 180, 240, \.\.\. Hz\), not at {rate:g} Hz"):
        PolicyPilot("hold_scratch", live, columns={"time_left": 4.0})


@pytest.mark.parametrize("name", folders())
def test_every_policy_that_comes_with_slipgym_starts_or_is_refused_by_what_it_reads(name):
    """It asks for columns of its task; with these it acts."""
    own = {column.name for column in find(policies.load(name).description.environment.id).columns}
    with pytest.raises(ValueError, match=r"give it, of the columns |of the sensors 'wrist'; live") as refused:
        session(name, timeout=1.0)
    if name == "carry_wrist":
        return
    names = str(refused.value).partition("of the columns ")[2].split(", ")
    assert set(names) <= own
    found = session(name, timeout=1.0, columns=dict.fromkeys(names, 0.0))
    assert play(found, seconds=0.3)[-1]["status"] == "ok"


@pytest.mark.parametrize(
    ("sensors", "config", "says"),
    [
        ("wrist", {}, "reads wrist_f_x, wrist_f_y, wrist_tau, motor_force, opening, of the sensors 'wrist'"),
        ("motor", {}, "reads motor_force, opening, of the sensors 'motor'"),
        ("markers", {"sensors": {"markers": {"observed": True}}}, r"reads marker_x_0_1, .*, \.\.\., of the"),
    ],
)
def test_a_policy_of_other_sensors_is_refused_by_what_it_reads(sensors, config, says, tmp_path):
    path = tmp_path / "policy" / "policy.json"
    shutil.copytree(folders()["carry_wrist"], path.parent)
    content = json.loads(path.read_text())
    content["environment"]["arguments"] |= {"sensors": sensors, "config": config}
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match=f"{says}.* live takes .* the fingers alone"):
        session(str(path.parent))
