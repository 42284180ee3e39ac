"""Saves and loads a physics client, bit for bit, as Bullet's own file of poses, velocities and contacts."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import Box

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


def save_engine(client: int) -> bytes:
    """State of the bodies of a client, as the content of a file."""
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        p.saveBullet(str(path), physicsClientId=client)
        return path.read_bytes()


def load_engine(client: int, content: bytes) -> None:
    """Restore what `save_engine` returned; the client's bodies were created in the same order.

    Bullet checks nothing of what it reads, so that a crafted file may crash the process: the checksums of a
    state are compared before.
    """
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        path.write_bytes(content)
        p.restoreState(fileName=str(path), physicsClientId=client)
