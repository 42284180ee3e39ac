"""Colours of the pictures: Okabe and Ito's colour-blind safe palette, as in the evaluation's figures."""

from __future__ import annotations

Colour = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

INK: Colour = (0x22, 0x22, 0x22)
MUTED: Colour = (0x76, 0x76, 0x76)
RULE: Colour = (0xE9, 0xEE, 0xF2)
PAPER: Colour = (255, 255, 255)
GRIP = INK
GRIP_2: Colour = (0x56, 0xB4, 0xE9)
SLIP: Colour = (0x00, 0x72, 0xB2)
FRICTION: Colour = (0xD5, 0x5E, 0x00)
MU_C = FRICTION
MU_S: Colour = (0x00, 0x9E, 0x73)
TARGET = MU_S
