import json
import zipfile

import gymnasium as gym
import numpy as np
import pytest

from policies.training import checkpoints


def test_a_tree_comes_back_as_it_was(tmp_path):
    tree = {
        "scalars": [None, True, 3, 2**80, 0.1, float("inf"), "µ"],
        "pairs": (1, (2, [3])),
        5: b"\x00\xff",
        "array": np.array([[1.5, np.nan]], np.float32),
        "rows": np.array([(1, 2.0)], [("a", "i8"), ("b", "f8")]),
        "nothing": {},
    }
    checkpoints.write(tmp_path / "file", tree)
    back = checkpoints.read(tmp_path / "file")
    assert list(back) == list(tree)
    for key in ("scalars", "pairs", 5, "nothing"):
        assert back[key] == tree[key]
        assert type(back[key]) is type(tree[key])
    for key in ("array", "rows"):
        assert back[key].dtype == tree[key].dtype
        np.testing.assert_array_equal(back[key], tree[key])


def test_the_state_of_an_environment_comes_back(tmp_path):
    env = gym.make("slipgym:slipgym/LinearSlip-v0", randomization="train").unwrapped
    env.reset(seed=1)
    env.step(np.zeros(1))
    checkpoints.write(tmp_path / "file", env.get_state())
    expected = env.step(np.zeros(1))[0]
    env.set_state(checkpoints.read(tmp_path / "file"))
    np.testing.assert_array_equal(env.step(np.zeros(1))[0], expected)
    env.close()


@pytest.mark.parametrize("value", [object(), {1, 2}, np.array([object()])])
def test_what_is_not_plain_is_refused(tmp_path, value):
    with pytest.raises((TypeError, ValueError)):
        checkpoints.write(tmp_path / "file", value)
    assert list(tmp_path.iterdir()) == []


def test_damage_is_noticed(tmp_path):
    path = tmp_path / "file"
    checkpoints.write(path, {"array": np.arange(1000)})
    content = path.read_bytes()
    for damaged in (content[:-1], content[: len(content) // 2], b"", b"junk"):
        path.write_bytes(damaged)
        with pytest.raises(ValueError, match="damaged"):
            checkpoints.read(path)


def test_a_member_that_was_exchanged_is_noticed(tmp_path):
    path, forged = tmp_path / "file", tmp_path / "forged"
    checkpoints.write(path, {"value": 1})
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(forged, "w") as new:
        new.writestr("tree.json", json.dumps({"mapping": [["value", 2]]}))
        new.writestr("sums.json", old.read("sums.json"))
    with pytest.raises(ValueError, match="checksum"):
        checkpoints.read(forged)


def test_no_pickle_is_read(tmp_path):
    path = tmp_path / "file"
    checkpoints.write(path, {"array": np.arange(3)})
    pickled = tmp_path / "pickled.npy"
    np.save(pickled, np.array([print], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="pickle"):
        checkpoints._decoded({"array": 0}, {"0.npy": pickled.read_bytes()})


def test_the_last_checkpoints_are_kept_and_a_damaged_one_is_passed_over(tmp_path):
    checkpoints.folder(tmp_path).mkdir()
    assert checkpoints.last(tmp_path) is None
    for steps in (5, 100, 20):
        checkpoints.save(tmp_path, steps, {"steps": steps}, keep=2)
    assert [path.stem for path in checkpoints.kept(tmp_path)] == ["000000000020", "000000000100"]
    assert checkpoints.last(tmp_path) == {"steps": 100}
    checkpoints.kept(tmp_path)[-1].write_bytes(b"torn")
    assert checkpoints.last(tmp_path) == {"steps": 20}
    checkpoints.kept(tmp_path)[0].write_bytes(b"torn")
    with pytest.raises(ValueError, match="damaged"):
        checkpoints.last(tmp_path)
