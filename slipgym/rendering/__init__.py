"""Pictures of the scene."""

from slipgym.rendering.camera import picture

__all__ = ["picture"]
