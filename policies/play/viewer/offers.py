"""Takes from the controls of the page only what they offer.

The server of the page hands on whatever a browser sends: any text from a menu, any number from a slider.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

_SHORT = 60  # characters of a refused value that a message shows


def one_of(names: Sequence[str]) -> Callable[[Any], str]:
    """Takes a name of a menu; raises ValueError for anything else."""
    offered = tuple(names)

    def take(value: Any) -> str:
        if not isinstance(value, str) or value not in offered:
            raise ValueError(f"is not on offer; there are {', '.join(offered)}")
        return value

    return take


def number(low: float, high: float, whole: bool = False) -> Callable[[Any], float]:
    """Takes a number of a slider; raises ValueError for what is outside, NaN or no number."""

    def take(value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            raise ValueError(f"must be a number from {low:g} to {high:g}")
        if whole and value != math.floor(value):
            raise ValueError(f"must be a whole number from {low:g} to {high:g}")
        return int(value) if whole else float(value)

    return take


def switch(value: Any) -> bool:
    """Takes the state of a checkbox; raises ValueError for anything else."""
    if not isinstance(value, bool):
        raise ValueError("must be on or off")
    return value


class Offer:
    """A control of the page; viser has the handle, and messages name it by its label.

    `take` gives the value that is taken for one that was sent, see `number`; if that is not on offer,
    `refuse` is called with a message.
    """

    def __init__(
        self, handle: Any, label: str, take: Callable[[Any], Any], refuse: Callable[[str], None]
    ) -> None:
        self._handle, self._label, self._take, self._refuse = handle, label, take, refuse
        self._value = handle.value

    @property
    def value(self) -> Any:
        """The last value that was on offer."""
        return self._value

    @value.setter
    def value(self, value: Any) -> None:
        self._value = self._handle.value = value

    def on_change(self, act: Callable[[Any], None]) -> None:
        """Calls `act` with the value whenever a user, and not the program, changed it."""
        self._handle.on_update(lambda event: self._changed(event, act))

    def on_click(self, act: Callable[[Any], None]) -> None:
        """Calls `act` with the value whenever a user clicked."""
        self._handle.on_click(lambda event: self._changed(event, act))

    def _changed(self, event: Any, act: Callable[[Any], None]) -> None:
        if event.client_id is None:
            return
        sent = self._handle.value
        try:
            self._value = self._take(sent)
        except ValueError as error:
            self._refuse(f"{self._label} = {repr(sent)[:_SHORT]} {error}")
            self._handle.value = self._value
            return
        act(self._value)
