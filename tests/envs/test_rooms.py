"""Rooms are the receiver's for as long as it has any part of them, and empty when they come back."""

import numpy as np
import pytest

from slipgym.envs.rooms import KEPT, Rooms
from slipgym.envs.told import Told

N, TERMS = 6, ("one", "two")


@pytest.fixture
def told():
    """Nothing of it is zero, and no two numbers of it are alike."""
    told = Told.zeros(N, len(TERMS))
    told.numbers[:] = 1.0 + np.arange(told.numbers.size).reshape(told.numbers.shape)
    told.terms[:] = -1.0 - np.arange(told.terms.size).reshape(told.terms.shape)
    told.flags[:] = True
    Rooms(N, TERMS).fill(np.array([0]), told)  # while it compiles, Numba keeps arguments for longer
    return told


def check(infos, told, rows):
    """What is told of some rows, and zeros elsewhere."""
    others = np.setdiff1d(np.arange(N), rows)
    expected = told.named(TERMS)
    assert infos.keys() == expected.keys()
    assert infos["reward_terms"].keys() == expected["reward_terms"].keys()
    for found, wanted in ((infos, expected), (infos["reward_terms"], expected["reward_terms"])):
        for name, values in found.items():
            if name != "reward_terms":
                np.testing.assert_array_equal(values[rows], wanted[name][rows], err_msg=name)
                assert not values[others].any(), name


def address(infos):
    return infos["true"].ctypes.data


def test_one_that_was_given_back_is_cleared(told):
    rooms = Rooms(N, TERMS)
    first = rooms.fill(np.array([1, 4]), told)
    check(first, told, [1, 4])
    where = address(first)
    del first
    second = rooms.fill(np.array([2, 4]), told)
    assert address(second) == where
    check(second, told, [2, 4])


@pytest.mark.parametrize("name", ["true", "estimated_per_finger", "dropped", "two"])
@pytest.mark.parametrize("part", [lambda array: array, lambda array: array[:2], np.transpose])
def test_one_that_is_in_use_stays_as_it_is_even_if_only_a_view_of_a_part_is_left(told, name, part):
    rooms = Rooms(N, TERMS)
    infos = rooms.fill(np.array([0, 3]), told)
    view = part({**infos, **infos["reward_terms"]}[name])
    before, where = view.copy(), address(infos)
    del infos
    for k in range(3):
        assert address(rooms.fill(np.array([k]), told)) != where
    np.testing.assert_array_equal(view, before)
    del view
    assert address(rooms.fill(np.array([5]), told)) == where


def test_there_is_room_for_all_that_are_kept(told):
    rooms = Rooms(N, TERMS)
    whole = [rooms.fill(np.array([k]), told) for k in range(KEPT + 2)]
    for k, infos in enumerate(whole):
        check(infos, told, [k])


def test_shape_type_and_flags_of_what_was_handed_out_are_the_receivers(told):
    rooms = Rooms(N, TERMS)
    infos = rooms.fill(np.array([0]), told)
    infos["time"].shape = (N, 1)
    infos["grip_force"].setflags(write=False)
    infos["slip"].dtype = np.int64
    infos["reward_terms"]["one"].setflags(write=False)
    np.logical_not(infos["dropped"], out=infos["dropped"])
    where = address(infos)
    del infos
    again = rooms.fill(np.array([2]), told)
    assert address(again) == where
    check(again, told, [2])
    assert again["grip_force"].flags.writeable
    assert again["reward_terms"]["one"].flags.writeable


def test_names_that_are_added_or_removed_do_not_come_back(told):
    rooms = Rooms(N, TERMS)
    infos = rooms.fill(np.array([0]), told)
    infos["mine"] = 1
    del infos["true"], infos["reward_terms"]["one"]
    check(rooms.fill(np.array([2]), told), told, [2])
    del infos
    check(rooms.fill(np.array([3]), told), told, [3])
