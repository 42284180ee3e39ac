"""How observations are laid out in every observation mode, and their history."""

import copy

import numpy as np
import pytest

from slipgym.envs.observation import WRIST as WRIST_READINGS

pytestmark = pytest.mark.quick_tasks

WRIST = {"action_mode": "grip_force_wrist"}
ACTIONS = np.random.default_rng(0).uniform(-1.0, 0.2, (40, 4))
ACTIONS[:, 1:] *= 0.1
TRUTH = {  # columns of the privileged group -> the same in info
    "true": ("mu_s", "mu_c", "r"),
    "slip": ("slip_x", "slip_y", "slip_theta"),
    "slip_twist": ("slip_velocity_x", "slip_velocity_y", "slip_rate"),
    "contact_wrench": tuple(f"friction_{a}_{f}" for f in (1, 2) for a in ("x", "y", "tau")),
    "grip_force": ("grip_force_1", "grip_force_2"),
}


def played(env, actions=ACTIONS) -> list[tuple]:
    """Observation and info of an episode's first steps."""
    said = [env.reset(seed=0, options={"object_mass": 0.3})]
    for action in actions[:, : env.action_space.shape[0]]:
        result = env.step(action)
        said.append((result[0], result[4]))
    return said


@pytest.mark.parametrize("source", ["estimated", "true", "none"])
def test_sensor_is_flat_without_friction(make, env_id, source):
    bare = make(env_id, friction_source="none")
    env = make(env_id, friction_source=source, observation_mode="sensor")
    assert env.columns == bare.columns
    for (observation, _), (expected, _) in zip(played(env), played(bare), strict=True):
        np.testing.assert_array_equal(observation, expected)


@pytest.mark.parametrize("source", ["estimated", "none"])
@pytest.mark.parametrize(("groups", "mode"), [("dict", "flat"), ("deviations_dict", "deviations")])
def test_the_policy_group_is_flat(make, env_id, source, groups, mode):
    flat = make(env_id, friction_source=source, observation_mode=mode, **WRIST)
    env = make(env_id, friction_source=source, observation_mode=groups, **WRIST)
    assert env.observation_space["policy"] == flat.observation_space
    for (observation, info), (expected, told) in zip(played(env), played(flat), strict=True):
        np.testing.assert_array_equal(observation["policy"], expected)
        assert repr(info) == repr(told)


def test_the_privileged_group_is_the_truth(make, env_id):
    env = make(env_id, observation_mode="dict", friction_source="none", **WRIST)
    names = [c.name for c in env.privileged_columns]
    space = env.observation_space["privileged"]
    assert np.isfinite([space.low, space.high]).all()
    np.testing.assert_array_equal(space.high, np.float32([c.high for c in env.privileged_columns]))
    for observation, info in played(env):
        truth = dict(zip(names, observation["privileged"], strict=True))
        for key, columns in TRUTH.items():
            seen = [truth.pop(name) for name in columns]
            np.testing.assert_array_equal(seen, info[key].astype(np.float32).ravel())
        assert truth.pop("object_mass") == np.float32(0.3)
    (x, _, z), orientation = env.simulation.world.reading[0]  # the engine's
    angle = -2.0 * np.arctan2(orientation[1], orientation[3])
    truth = {name: value for name, value in truth.items() if name.startswith("object")}
    assert truth == pytest.approx({"object_x": x, "object_z": z, "object_angle": angle}, abs=1e-5)
    assert np.abs([x, z, angle]).max() > 1e-3


def test_the_privileged_group_stays_in_its_bounds_through_a_fall(make):
    env = make(observation_mode="dict")
    env.reset(seed=0)
    for _ in range(400):
        assert env.observation_space.contains(env.step([-1.0])[0])
    at = [c.name for c in env.privileged_columns].index("object_z")
    assert env.step([-1.0])[0]["privileged"][at] == -10.0


def test_the_wrist_part_holds_what_the_task_does_not(make, env_id):
    plain = {c.name for c in make(env_id).columns}
    for mode, expected in (
        ("grip_force", set()),
        ("force_increment", set()),
        ("grip_force_pitch", {"wrist_pitch", "wrist_pitch_rate"}),
        ("grip_force_translation", {"wrist_velocity_x", "wrist_velocity_z", "wrist_pitch"}),
        ("grip_force_wrist", {c.name for c in WRIST_READINGS}),
    ):
        names = [c.name for c in make(env_id, action_mode=mode).columns]
        assert set(names) == plain | expected
        assert len(set(names)) == len(names)


@pytest.mark.parametrize("mode", ["flat", "sensor", "dict"])
def test_history_is_the_last_observations(make, env_id, mode):
    plain = make(env_id, observation_mode=mode)
    env = make(env_id, observation_mode=mode, history=2)

    def policy(observation):
        return observation["policy"] if mode == "dict" else observation

    alone = [policy(observation) for observation, _ in played(plain)]
    padded = [alone[0], alone[0], *alone]
    for k, (observation, _) in enumerate(played(env)):
        np.testing.assert_array_equal(policy(observation), np.concatenate(padded[k : k + 3]))
    assert [c.name for c in env.columns] == [c.name for c in plain.columns]
    # nothing of an episode is left in the next one
    np.testing.assert_array_equal(policy(played(env)[0][0]), np.concatenate(padded[:3]))


def test_history_is_part_of_the_state(make, env_id):
    env = make(env_id, observation_mode="dict", history=3, **WRIST)
    played(env, ACTIONS[:20])
    twin, other = copy.deepcopy(env), make(env_id, observation_mode="dict", history=3, **WRIST)
    other.set_state(env.get_state())
    for action in ACTIONS[20:]:
        said = repr(env.step(action))
        assert said == repr(twin.step(action)) == repr(other.step(action))
    with pytest.raises(ValueError, match="another history: 3, here 2"):
        make(env_id, observation_mode="dict", history=2, **WRIST).set_state(env.get_state())
    twin.close()
