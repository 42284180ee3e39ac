"""Writes text over the view: task, state of the object, and legend of the marks."""

from __future__ import annotations

import math

import numpy as np
from PIL import Image

from slipgym.rendering.forces import Contact
from slipgym.rendering.palette import FRICTION, GRIP, INK, MUTED, PAPER, SLIP, TARGET, Colour
from slipgym.rendering.poses import Pose
from slipgym.rendering.text import write

_FOOT = 46  # height of the band with the keys [pixels]


def caption(
    picture: Image.Image,
    title: str,
    about: str,
    time: float,
    state: str,
    contact: Contact,
    slip: np.ndarray,
    target: Pose | None = None,
    scale: float = 1.0,
) -> None:
    """Write text over the view.

    Args:
        picture: The view, RGB, written into.
        title: Title, the name of the task.
        about: Description of the object.
        time: Time since the start [s].
        state: State of the object, such as whether it slips.
        contact: Forces of the pads on the object.
        slip: Slip displacement (x, y, theta) [m, m, rad].
        target: The one that the task asks for; None: none.
        scale: Size of the words, over that in a picture of the usual size.
    """
    right, bottom = picture.width / scale - 14, picture.height / scale - _FOOT

    def put(x: float, y: float, words: str, colour: Colour, size: float = 13, align: float = 0.0) -> None:
        write(picture, scale * x, scale * y, words, colour, scale * size, align)

    put(14, 26, title, INK, 17)
    put(14, 45, about, MUTED)
    put(right, 26, f"{time:.2f} s", INK, 17, align=1.0)
    put(right, 45, state, MUTED, align=1.0)
    put(14, bottom - 10, "dashed:", MUTED)
    put(66, bottom - 10, "grasp", SLIP)
    if target is not None:
        put(106, bottom - 10, "target", TARGET)
    foot = 0, round(scale * bottom), picture.width, picture.height
    picture.paste(PAPER, foot, Image.new("L", (foot[2], foot[3] - foot[1]), 191))
    friction, torque = math.hypot(*contact.friction), 1e3 * contact.torque
    sliding, turn = 1e3 * math.hypot(slip[0], slip[1]), math.degrees(slip[2])
    keys = (
        ("grip force", GRIP, f"{contact.grip[0]:.1f} N", f"{contact.grip[1]:.1f} N"),
        ("friction on the object", FRICTION, f"{friction:.2f} N", f"{_signed(torque, 0)} mN m"),
        ("slip since the grasp", SLIP, f"{sliding:.1f} mm", f"{_signed(turn, 1)}°"),
    )
    for k, (words, colour, first, second) in enumerate(keys):
        x = 14 + (0, 128, 296)[k]
        put(x, bottom + 19, words, colour)
        put(x, bottom + 36, first, INK)
        put(x + 58, bottom + 36, second, INK)


def _signed(value: float, digits: int) -> str:
    """A number with its sign, and zero without."""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0:.{digits}f}"
