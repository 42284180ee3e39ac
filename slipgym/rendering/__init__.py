"""Renders the environments."""

from slipgym.rendering.layout import HEIGHT, WIDTH
from slipgym.rendering.renderer import WINDOW_RATE, Renderer
from slipgym.rendering.window import Window

__all__ = ["HEIGHT", "WIDTH", "WINDOW_RATE", "Renderer", "Window"]
