"""A window on the screen, by pygame."""

from __future__ import annotations

import os

import numpy as np

_NO_SCREEN = ("offscreen", "dummy")  # drivers that SDL falls back to
_HINT = "use render_mode='rgb_array', or write a film: python scripts/play.py LinearSlip --video film.mp4"


class Window:
    """Shows pictures, and tells which keys are down.

    Args:
        title: In its bar.
        size: Width and height [pixels].

    Raises:
        ImportError: pygame is not installed.
        RuntimeError: There is no screen.
    """

    def __init__(self, title: str, size: tuple[int, int]) -> None:
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
        try:
            import pygame
        except ImportError as error:
            raise ImportError(f"a window needs pygame: pip install 'slipgym[window]'; or {_HINT}") from error
        self._pygame = pygame
        try:
            pygame.display.init()
        except pygame.error as error:
            raise RuntimeError(f"there is no screen for a window ({error}); {_HINT}") from error
        driver = pygame.display.get_driver()
        if driver in _NO_SCREEN and os.environ.get("SDL_VIDEODRIVER") != driver:
            pygame.display.quit()
            raise RuntimeError(f"there is no screen for a window; {_HINT}")
        pygame.display.set_caption(title)
        self._screen = pygame.display.set_mode(size)
        self._clock = pygame.time.Clock()
        self.closed = False
        """Whether someone closed the window, or pressed Escape."""

    def show(self, picture: np.ndarray, rate: float) -> None:
        """Show a picture, no sooner than 1/rate after the last one.

        Args:
            picture: (height, width, 3) uint8.
            rate: Pictures per second, at most.
        """
        pygame = self._pygame
        for event in pygame.event.get():
            escaped = event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE
            self.closed = self.closed or escaped or event.type == pygame.QUIT
        pygame.surfarray.blit_array(self._screen, picture.swapaxes(0, 1))
        pygame.display.flip()
        self._clock.tick(rate)

    def vertical(self) -> int:
        """1 while the up key is down, -1 while the down key is, else 0."""
        keys = self._pygame.key.get_pressed()
        return int(keys[self._pygame.K_UP]) - int(keys[self._pygame.K_DOWN])

    def close(self) -> None:
        """Take the window off the screen; doing so twice is harmless."""
        self._pygame.display.quit()
