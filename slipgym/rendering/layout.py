"""Lays a picture out: how large are the view, the plots beside it, the words and the marks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

WIDTH, HEIGHT = 720, 480
"""Size of a picture, unless another one is asked for [pixels]."""
STRIP = 272
"""Width of the plots in it [pixels]."""
_READABLE = 2.0 / 3.0  # least scale with words
_VISIBLE = 0.4  # least scale of marks


@dataclass(frozen=True)
class Layout:
    """Sizes of a picture and its parts."""

    width: int
    """Of the view [pixels]."""
    height: int
    """Of view and picture [pixels]."""
    scale: float = 1.0
    """Size of words and marks over that in a picture of `WIDTH` by `HEIGHT`."""
    strip: int = STRIP
    """Width of the plots beside the view [pixels]; 0: no plots and no words."""


def arrange(mode: str, size: Sequence[int] | None) -> Layout:
    """Lay a picture of a render mode out; its size is width and height [pixels], None for the mode's own.

    The view stands alone in a "depth_array", and where words would be too small to read.
    """
    width, height = size or (WIDTH - STRIP * (mode == "depth_array"), HEIGHT)
    scale = min(width / WIDTH, height / HEIGHT)
    if mode == "depth_array" or scale < _READABLE:
        return Layout(width, height, max(scale, _VISIBLE), strip=0)
    strip = round(scale * STRIP)
    return Layout(width - strip, height, scale, strip)
