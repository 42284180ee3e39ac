"""A physics client of PyBullet that belongs to one world, and notices when it no longer does."""

from __future__ import annotations

from itertools import count

from slipgym.world import scene
from slipgym.world.quiet_pybullet import p

GONE = (
    "the physics client of this environment is gone: pybullet.disconnect() was called for it, "
    "or another client has taken its number; make a new environment"
)
_KEY = "slipgym"
_marks = count()


class Client:
    """A physics client, recognised by a mark on one of its bodies.

    PyBullet gives the number of a disconnected client to the next one. Without the mark, a world would then
    drive, or disconnect, a client that belongs to somebody else.

    Raises:
        RuntimeError: PyBullet has no client left.
    """

    def __init__(self) -> None:
        self._mark = f"{next(_marks)}".encode()
        self._place: int | None = None
        self._number: int | None = scene.connect()
        self.mark(p.createMultiBody(0.0, physicsClientId=self._number))

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._number is None

    @property
    def number(self) -> int:
        """PyBullet's id of the client.

        Raises:
            RuntimeError: It is closed.
        """
        if self._number is None:
            raise RuntimeError("this environment is closed; make a new one")
        return self._number

    def checked(self) -> int:
        """PyBullet's id of the client, which is still the one that was made.

        Raises:
            RuntimeError: It is closed, was disconnected, or its number belongs to another client.
        """
        number = self.number
        if not self._owned(number):
            raise RuntimeError(GONE)
        return number

    def unmark(self) -> None:
        """Expect the bodies to be removed; `mark` must follow."""
        self._place = None

    def mark(self, body: int) -> None:
        """Mark a body, by which the client is recognised."""
        text = self._mark.decode()
        self._place = p.addUserData(body, _KEY, text, physicsClientId=self.number)

    def close(self) -> None:
        """Disconnect it unless somebody else did; closing twice is harmless."""
        if self._number is not None:
            if self._owned(self._number):
                p.disconnect(physicsClientId=self._number)
            self._number = None

    def _owned(self, number: int) -> bool:
        try:
            if self._place is None:  # the bodies are being built
                return p.isConnected(number) == 1
            return p.getUserData(self._place, number) == self._mark
        except p.error:
            return False
