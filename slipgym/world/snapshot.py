"""Saves and loads a physics client, bit for bit, as Bullet's own file of poses, velocities and contacts."""

from __future__ import annotations

import hashlib
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import Box
from slipgym.world.trial import survives

_NAME = "world.bullet"


@dataclass(frozen=True)
class EngineState:
    """Plain data that the engine's next step depends on."""

    engine: bytes
    """Bullet's own file of its bodies."""
    box: Box
    """The box of the episode."""
    reading: tuple[Any, ...]
    """`BulletWorld.reading` at that time."""


class _Known:
    """Remembers the newest files that this process has saved or tried."""

    def __init__(self, most: int) -> None:
        self._digests: dict[bytes, None] = {}
        self._most = most

    def add(self, content: bytes) -> None:
        """Remember a content."""
        self._digests[hashlib.sha256(content).digest()] = None
        while len(self._digests) > self._most:
            self._digests.pop(next(iter(self._digests)))

    def __contains__(self, content: bytes) -> bool:
        return hashlib.sha256(content).digest() in self._digests


_known = _Known(4096)


def save_engine(client: int) -> bytes:
    """State of the bodies of a client, as the content of a file."""
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        p.saveBullet(str(path), physicsClientId=client)
        content = path.read_bytes()
    _known.add(content)
    return content


def load_engine(client: int, content: bytes) -> None:
    """Restore what `save_engine` returned; the client's bodies were created in the same order.

    Bullet checks nothing of what it reads: most damaged files crash the process. A file that this process
    does not know is first restored in a copy of the process.

    Raises:
        ValueError: Bullet does not read it, or crashes.
    """
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        path.write_bytes(content)

        def restore() -> None:
            p.restoreState(fileName=str(path), physicsClientId=client)

        def go_on() -> None:
            restore()
            p.stepSimulation(client)

        if content not in _known and not survives(go_on):
            raise ValueError("the state is damaged: PyBullet cannot restore its part")
        _known.add(content)
        restore()
