"""Writes text over the view: task, state of the object, and legend of the marks."""

from __future__ import annotations

import math

import numpy as np
from PIL import Image

from slipgym.rendering.camera import HEIGHT, WIDTH
from slipgym.rendering.forces import Contact
from slipgym.rendering.palette import FRICTION, GRIP, INK, MUTED, PAPER, SLIP, TARGET
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
    """
    write(picture, 14, 26, title, INK, 17)
    write(picture, 14, 45, about, MUTED, 13)
    write(picture, WIDTH - 14, 26, f"{time:.2f} s", INK, 17, align=1.0)
    write(picture, WIDTH - 14, 45, state, MUTED, 13, align=1.0)
    if target is not None:
        write(picture, 14, HEIGHT - _FOOT - 10, "dashed:", MUTED, 13)
        write(picture, 66, HEIGHT - _FOOT - 10, "grasp", SLIP, 13)
        write(picture, 106, HEIGHT - _FOOT - 10, "target", TARGET, 13)
    foot = 0, HEIGHT - _FOOT, WIDTH, HEIGHT
    picture.paste(PAPER, foot, Image.new("L", (WIDTH, _FOOT), 191))
    friction, torque = math.hypot(*contact.friction), 1e3 * contact.torque
    sliding, turn = 1e3 * math.hypot(slip[0], slip[1]), math.degrees(slip[2])
    keys = (
        ("grip force", GRIP, f"{contact.grip[0]:.1f} N", f"{contact.grip[1]:.1f} N"),
        ("friction on the object", FRICTION, f"{friction:.2f} N", f"{_signed(torque, 0)} mN m"),
        ("slip since the grasp", SLIP, f"{sliding:.1f} mm", f"{_signed(turn, 1)}°"),
    )
    for k, (words, colour, first, second) in enumerate(keys):
        x = 14 + (0, 128, 296)[k]
        write(picture, x, HEIGHT - _FOOT + 19, words, colour, 13)
        write(picture, x, HEIGHT - _FOOT + 36, first, INK, 13)
        write(picture, x + 58, HEIGHT - _FOOT + 36, second, INK, 13)


def _signed(value: float, digits: int) -> str:
    """A number with its sign, and zero without."""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0:.{digits}f}"
