"""Writes text into a picture, in the typeface that comes with Pillow."""

from __future__ import annotations

from functools import lru_cache

from PIL import Image, ImageDraw, ImageFont
from PIL.ImageFont import FreeTypeFont

from slipgym.rendering.palette import Colour


def write(
    picture: Image.Image,
    x: float,
    y: float,
    words: str,
    colour: Colour,
    size: float = 12,
    align: float = 0.0,
) -> None:
    """Write one line of ASCII and a few signs more (° and ·) into a picture, RGB.

    Its baseline is at y [pixels]; x is its left end (align 0), its middle (0.5) or its right end (1).
    """
    mask, rise = _mask(words, size)
    picture.paste(colour, (round(x - align * mask.width), round(y) - rise), mask)


def breadth(words: str, size: float) -> int:
    """Width of a line [pixels]."""
    return _mask(words, size)[0].width


@lru_cache(maxsize=8)
def _font(size: float) -> FreeTypeFont:
    font = ImageFont.load_default(size)
    if not isinstance(font, FreeTypeFont):
        raise RuntimeError("pictures need a Pillow with FreeType, as its wheels on PyPI have it")
    return font


@lru_cache(maxsize=1024)
def _mask(words: str, size: float) -> tuple[Image.Image, int]:
    """Coverage of a line, and how far its top is above the baseline [pixels]."""
    font = _font(size)
    left, top, right, bottom = font.getbbox(words, anchor="ls")
    mask = Image.new("L", (int(right - left) + 1, int(bottom - top) + 1))
    ImageDraw.Draw(mask).text((-left, -top), words, fill=255, font=font, anchor="ls")
    return mask, -int(top)
