"""Pictures of the scene."""

from slipgym.rendering.bullet import look
from slipgym.rendering.camera import picture
from slipgym.rendering.stage import View

__all__ = ["View", "look", "picture"]
