"""Writes text into a picture, in the typeface that comes with Pillow."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from PIL.ImageFont import FreeTypeFont

from slipgym.rendering.palette import Colour
from slipgym.rendering.raster import tint


def write(
    picture: np.ndarray,
    x: float,
    y: float,
    words: str,
    colour: Colour,
    size: int = 12,
    align: float = 0.0,
) -> None:
    """Write one line.

    Args:
        picture: (height, width, 3) uint8, written into.
        x: Position of the line [pixels], see `align`.
        y: Baseline [pixels].
        words: ASCII and a few signs more (° and ·).
        colour: Their colour.
        size: Height of the typeface [pixels].
        align: 0: x is the left end; 0.5: the middle; 1: the right end.
    """
    mask, rise = _mask(words, size)
    height, width = mask.shape
    left, top = round(x - align * width), round(y) - rise
    part = picture[top : top + height, left : left + width]
    tint(part, mask[: part.shape[0], : part.shape[1]], colour)


def breadth(words: str, size: int) -> int:
    """Width of a line [pixels]."""
    return _mask(words, size)[0].shape[1]


@lru_cache(maxsize=8)
def _font(size: int) -> FreeTypeFont:
    font = ImageFont.load_default(size)
    if not isinstance(font, FreeTypeFont):
        raise RuntimeError("pictures need a Pillow with FreeType, as its wheels on PyPI have it")
    return font


@lru_cache(maxsize=1024)
def _mask(words: str, size: int) -> tuple[np.ndarray, int]:
    """Coverage (height, width) of a line, and how far its top is above the baseline."""
    font = _font(size)
    left, top, right, bottom = font.getbbox(words, anchor="ls")
    canvas = Image.new("L", (int(right - left) + 1, int(bottom - top) + 1))
    ImageDraw.Draw(canvas).text((-left, -top), words, fill=255, font=font, anchor="ls")
    return np.asarray(canvas, dtype=np.float32) / np.float32(255.0), -int(top)
