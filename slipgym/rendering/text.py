"""Writes text into a picture in the typeface of Pillow: one line, or all that stands over a view."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from PIL.ImageFont import FreeTypeFont

from slipgym.rendering.look import Contact
from slipgym.rendering.palette import FRICTION, GRIP, INK, MUTED, PAPER, SLIP, TARGET, Colour

_FOOT = 46  # height of the band with the keys [pixels]


def write(
    picture: Image.Image, x: float, y: float, words: str, colour: Colour, size: float = 12, align: float = 0.0
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


def caption(
    picture: Image.Image,
    words: tuple[str, str, str, str],
    contact: Contact,
    slip: np.ndarray,
    target: bool,
    scale: float,
) -> None:
    """Write text over a view, RGB: title and description at the left, time and state at the right; the keys.

    The slip is a displacement (x, y, theta) [m, m, rad]; there may be a target for it.
    """
    right, bottom = picture.width / scale - 14, picture.height / scale - _FOOT

    def put(x: float, y: float, words: str, colour: Colour, size: float = 13, align: float = 0.0) -> None:
        write(picture, scale * x, scale * y, words, colour, scale * size, align)

    put(14, 26, words[0], INK, 17)
    put(14, 45, words[1], MUTED)
    put(right, 26, words[2], INK, 17, align=1.0)
    put(right, 45, words[3], MUTED, align=1.0)
    put(14, bottom - 10, "dashed:", MUTED)
    put(66, bottom - 10, "grasp", SLIP)
    if target:
        put(106, bottom - 10, "target", TARGET)
    foot = 0, round(scale * bottom), picture.width, picture.height
    picture.paste(PAPER, foot, Image.new("L", (foot[2], foot[3] - foot[1]), 191))
    friction, torque = math.hypot(*contact.friction), 1e3 * contact.torque
    sliding, turn = 1e3 * math.hypot(slip[0], slip[1]), math.degrees(slip[2])
    keys = (
        (14, "grip force", GRIP, f"{contact.grip[0]:.1f} N", f"{contact.grip[1]:.1f} N"),
        (142, "friction on the object", FRICTION, f"{friction:.2f} N", f"{_signed(torque, 0)} mN m"),
        (310, "slip since the grasp", SLIP, f"{sliding:.1f} mm", f"{_signed(turn, 1)}°"),
    )
    for x, key, colour, first, second in keys:
        put(x, bottom + 19, key, colour)
        put(x, bottom + 36, first, INK)
        put(x + 58, bottom + 36, second, INK)


def _signed(value: float, digits: int) -> str:
    """A number with its sign, and zero without."""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0:.{digits}f}"
