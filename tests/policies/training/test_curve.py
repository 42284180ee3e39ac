"""Which point of a learning curve a run's policy is of."""

import pytest

pytest.importorskip("matplotlib")
from policies.training.curve import Row, best


def rows(*points):
    return [Row(100 * k, success, 0.0, reward, 1.0) for k, (success, reward) in enumerate(points)]


@pytest.mark.parametrize(
    ("points", "chosen"),
    [
        ([(0.5, 1.0)], 0),
        ([(0.5, 1.0), (0.5, 1.0)], 0),
        ([(0.5, 1.0), (0.5, 2.0)], 1),
        # a standard error is 1.3 % at 0.96
        ([(0.96, 1.0), (0.95, 2.0)], 1),
        ([(0.96, 1.0), (0.94, 2.0)], 0),
        # below what is chosen by noise, but not below the most
        ([(0.96, 1.0), (0.95, 2.0), (0.94, 3.0)], 1),
        # of all solved one less is noise
        ([(1.0, 1.0), (255 / 256, 2.0), (253 / 256, 3.0)], 1),
        # the new most leaves the chosen behind
        ([(0.90, 5.0), (0.95, 1.0)], 1),
    ],
)
def test_the_best_has_most_reward_of_those_that_solve_as_many(points, chosen):
    found = rows(*points)
    assert best(found, 256) is found[chosen]


def test_fewer_episodes_mean_more_noise():
    found = rows((0.96, 1.0), (0.94, 2.0))
    assert best(found, 64) is found[1]


def test_the_best_of_the_first_is_found_without_the_later_ones():
    """As a run keeps it: what is passed over once is gone."""
    found = rows((0.90, 3.0), (0.94, 2.0), (0.93, 2.5), (0.97, 1.0), (0.96, 1.5))
    kept = None
    for k in range(1, len(found) + 1):
        now = best(found[:k], 256)
        assert now is found[k - 1] or now is kept
        kept = now
    assert kept is found[4]
