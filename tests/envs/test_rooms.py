"""Rooms are the receiver's for as long as it has them, and empty when they come back."""

import numpy as np

from slipgym.envs.rooms import KEPT, Rooms


def filled(rooms: Rooms, *rows: int) -> np.ndarray:
    return rooms.fill(np.array(rows), np.full((len(rows), 2), 1.0 + rows[0]))


def expected(*rows: int) -> np.ndarray:
    array = np.zeros((6, 2))
    array[list(rows)] = 1.0 + rows[0]
    return array


def test_one_that_was_given_back_is_cleared():
    rooms = Rooms(6, 2)
    first = filled(rooms, 1, 4)
    np.testing.assert_array_equal(first, expected(1, 4))
    address = first.ctypes.data
    del first
    second = filled(rooms, 2)
    assert second.ctypes.data == address
    np.testing.assert_array_equal(second, expected(2))


def test_one_that_is_in_use_stays_as_it_is_even_if_only_a_view_is_left():
    rooms = Rooms(6, 2)
    whole = [filled(rooms, k) for k in range(KEPT + 2)]
    view = whole[0][:, 1:].reshape(6)
    del whole[0]
    for k in range(3):
        filled(rooms, k)
    np.testing.assert_array_equal(view, expected(0)[:, 1])
    for k, room in enumerate(whole, start=1):
        np.testing.assert_array_equal(room, expected(k))
