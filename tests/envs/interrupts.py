"""Raises exceptions in the middle of calls: at a line of slipgym, or at a call of PyBullet."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import slipgym

_PACKAGE = str(Path(slipgym.__file__).parent)


class Interrupted(BaseException):
    """Stands for Ctrl-C: no code expects it."""


class Moments:
    """Counts moments, and raises `Interrupted` at one of them.

    Args:
        at: Number of the moment, counted from 1; 0: none.

    Attributes:
        count: Moments so far.
    """

    def __init__(self, at: int = 0) -> None:
        self.at, self.count = at, 0

    def __call__(self) -> None:
        """One more moment.

        Raises:
            Interrupted: It is the one.
        """
        self.count += 1
        if self.count == self.at:
            raise Interrupted


Place = Callable[[Moments], Any]
"""Context manager in which moments occur."""


@contextmanager
def lines(moments: Moments) -> Iterator[None]:
    """Each line of slipgym that this thread executes is a moment."""

    def entered(frame: FrameType, event: str, _: Any) -> Any:
        return executed if frame.f_code.co_filename.startswith(_PACKAGE) else None

    def executed(frame: FrameType, event: str, _: Any) -> Any:
        if event == "line" and frame.f_code.co_name != "__del__":
            moments()
        return executed

    before = sys.gettrace()
    sys.settrace(entered)
    try:
        yield
    finally:
        sys.settrace(before)


@contextmanager
def _engine(moments: Moments, after: bool) -> Iterator[None]:
    import pybullet

    names = [name for name in dir(pybullet) if name[0].islower() and name != "error"]
    originals = {name: getattr(pybullet, name) for name in names if callable(getattr(pybullet, name))}

    def counted(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **keywords: Any) -> Any:
            if not after:
                moments()
            result = function(*arguments, **keywords)
            if after:
                moments()
            return result

        return call

    for name, function in originals.items():
        setattr(pybullet, name, counted(function))
    try:
        yield
    finally:
        for name, function in originals.items():
            setattr(pybullet, name, function)


def before_engine(moments: Moments) -> Any:
    """Each call of PyBullet is a moment, before it happens."""
    return _engine(moments, after=False)


def after_engine(moments: Moments) -> Any:
    """Each call of PyBullet is a moment, when it has happened and nobody has its result."""
    return _engine(moments, after=True)


def count(place: Place, call: Callable[[], Any]) -> int:
    """How many moments a call has."""
    moments = Moments()
    with place(moments):
        call()
    return moments.count


def interrupt(place: Place, at: int, call: Callable[[], Any]) -> bool:
    """Make a call and interrupt it at a moment.

    Returns:
        Whether it was interrupted: False if it ended before.
    """
    try:
        with place(Moments(at)):
            call()
    except Interrupted:
        return True
    return False
