"""Two processes that play alone or at the same time."""

from slipgym.benchmarking.twins import Twins


class Sleeper:
    """Plays by pretending: the second block takes three times as long as the first."""

    def __init__(self, cost: float) -> None:
        self._cost = cost

    def block(self, steps: int) -> tuple[float, int]:
        self._cost *= 3.0
        return self._cost * steps / 3.0, steps


def test_one_plays_while_the_other_rests_and_both_at_once():
    with Twins(Sleeper, 0.5) as twins:
        assert twins.alone(4) == (2.0, 4)
        assert twins.both(4) == (6.0, 8)  # the first player's second block is the longer one
        assert not any(process.exitcode is not None for process in twins._processes)
    assert [process.exitcode for process in twins._processes] == [0, 0]
