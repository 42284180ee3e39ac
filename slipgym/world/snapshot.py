"""Bullet's own file of a world: poses, velocities and cached contacts, equal bit for bit after loading."""

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
    """What the engine's next step depends on, as plain data."""

    engine: bytes
    """Bullet's own file of its bodies."""
    box: Box
    """The box of the episode."""
    reading: tuple[Any, ...]
    """What the engine said last, as `BulletWorld.reading`."""


def save_engine(client: int) -> bytes:
    """What the engine remembers of the bodies of a client."""
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        p.saveBullet(str(path), physicsClientId=client)
        return path.read_bytes()


def load_engine(client: int, content: bytes) -> None:
    """Give the bodies of a client, created in the same order, what `save_engine` returned."""
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        path.write_bytes(content)
        p.restoreState(fileName=str(path), physicsClientId=client)
