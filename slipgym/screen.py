"""Finds out whether there is a screen, and shows pictures in a window, with pygame. Imports nothing heavy."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec

import numpy as np

_DISPLAYS = "DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"
_OTHERWISE = "; use render_mode='rgb_array', or write a video: slipgym play linear_slip --video video.mp4"


def obstacle() -> str:
    """The reason why no window can open here; empty if one can.

    `SDL_VIDEODRIVER=dummy` counts as a screen: windows then open where nobody sees them.
    """
    if find_spec("pygame") is None:
        return "pygame is not installed: pip install 'slipgym[window]'"
    if sys.platform == "linux" and not any(map(os.environ.get, _DISPLAYS)):
        return "there is no screen: none of DISPLAY, WAYLAND_DISPLAY and SDL_VIDEODRIVER is set"
    return ""


class Window:
    """Shows pictures, and reads the keyboard.

    Args:
        title: Title of the window.
        size: Width and height [pixels].

    Raises:
        RuntimeError: There is no screen, or pygame is not installed; the message says what to do.
    """

    def __init__(self, title: str, size: tuple[int, int]) -> None:
        if why := obstacle():
            raise RuntimeError(f"a window cannot open: {why}{_OTHERWISE}")
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
        import pygame

        self._pygame = pygame
        try:
            pygame.display.init()
        except pygame.error as error:
            raise RuntimeError(f"a window cannot open: {error}{_OTHERWISE}") from error
        pygame.display.set_caption(title)
        self._screen = pygame.display.set_mode(size)
        self._clock = pygame.time.Clock()
        self.closed = False
        """Whether the user closed the window or pressed Escape."""

    def show(self, picture: np.ndarray, rate: float) -> None:
        """Show a picture (height, width, 3) uint8, no sooner than 1/rate [s] after the last one."""
        pygame = self._pygame
        for event in pygame.event.get():
            escaped = event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE
            self.closed = self.closed or escaped or event.type == pygame.QUIT
        pygame.surfarray.blit_array(self._screen, picture.swapaxes(0, 1))
        pygame.display.flip()
        self._clock.tick(rate)

    def vertical(self) -> int:
        """1 while the up key is down, -1 while the down key is down, else 0."""
        keys = self._pygame.key.get_pressed()
        return int(keys[self._pygame.K_UP]) - int(keys[self._pygame.K_DOWN])

    def close(self) -> None:
        """Close the window; closing twice is harmless."""
        self._pygame.display.quit()
