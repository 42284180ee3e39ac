"""Times functions: many calls of one, or all of a program where they are looked up."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter
from typing import Any


def per_call(function: Callable[[], Any], calls: int, repeats: int = 15) -> float:
    """Median time of a call [s], over repeats of so many calls."""
    times = []
    for _ in range(repeats):
        start = perf_counter()
        for _ in range(calls):
            function()
        times.append((perf_counter() - start) / calls)
    return median(times)


class Stopwatches:
    """Times functions where they are looked up; as a context manager it puts them back.

    A function called by another timed one counts for itself only. The watches' own cost is
    measured and taken off.

    Args:
        clock: Returns a time [s]; the wall clock if None.

    Attributes:
        running: Whether calls are timed.
        spent: Time by label [s].
    """

    def __init__(self, clock: Callable[[], float] | None = None) -> None:
        self.running, self._clock = True, clock or perf_counter
        self.spent: dict[str, float] = {}
        self._inner = [0.0]
        self._replaced: list[tuple[Any, str, Any, bool]] = []
        self._cost = 0.0
        idle = self.timed("", lambda: None)
        self._cost = per_call(idle, 2000)
        self.spent.clear()

    def watch(self, label: str, owner: Any, name: str) -> None:
        """Time the function that `owner.name` looks up, under a label that others may share."""
        original = getattr(owner, name)
        self._replaced.append((owner, name, original, name in vars(owner)))
        setattr(owner, name, self.timed(label, original))

    def timed(self, label: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function with a stopwatch, for whoever puts it in place by other means than `watch`."""
        spent, inner, clock = self.spent, self._inner, self._clock
        spent.setdefault(label, 0.0)

        def timed(*arguments: Any, **keywords: Any) -> Any:
            if not self.running:
                return function(*arguments, **keywords)
            inner.append(0.0)
            start = clock()
            try:
                return function(*arguments, **keywords)
            finally:
                elapsed = clock() - start
                spent[label] += elapsed - inner.pop()
                inner[-1] += elapsed + self._cost

        return timed

    def __enter__(self) -> Stopwatches:
        return self

    def __exit__(self, *_: object) -> None:
        for owner, name, original, own in reversed(self._replaced):
            if own:
                setattr(owner, name, original)
            else:
                delattr(owner, name)
