"""Renders the environments."""

from slipgym.rendering.camera import PICTURE_HEIGHT as HEIGHT
from slipgym.rendering.camera import PICTURE_WIDTH as WIDTH
from slipgym.rendering.renderer import WINDOW_RATE, Renderer
from slipgym.screen import Window

__all__ = ["HEIGHT", "WIDTH", "WINDOW_RATE", "Renderer", "Window"]
