"""Pictures of the environments."""

from slipgym.rendering.renderer import HEIGHT, WIDTH, Renderer
from slipgym.rendering.window import Window

__all__ = ["HEIGHT", "WIDTH", "Renderer", "Window"]
