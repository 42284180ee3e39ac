"""Renders the environments."""

from slipgym.rendering.renderer import HEIGHT, WIDTH, WINDOW_RATE, Renderer
from slipgym.rendering.window import Window

__all__ = ["HEIGHT", "WIDTH", "WINDOW_RATE", "Renderer", "Window"]
