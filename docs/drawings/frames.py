"""Draws docs/images/frames.png: frames, gripper and sensors as docs/glossary.md defines them.

    python docs/drawings/frames.py [PATH]

Lengths are the default configuration's, in millimetres.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle, FancyArrowPatch, FancyBboxPatch, Polygon, Rectangle

from policies.evaluation.plots.style import STYLE, styled
from slipgym.config import load
from slipgym.sensors.slip_velocity import chip_positions

BLUE, ORANGE, GREEN, PINK = STYLE.palette[:4]
WOOD, WOOD_EDGE = "#EBD6B6", "#B08A55"
STEEL, STEEL_EDGE = "#D5DBE1", "#8A949E"
PAD = "#5B6672"
IMAGE = Path(__file__).resolve().parents[1] / "images" / "frames.png"


def draw(path: Path) -> None:
    """Write the drawing to a PNG file."""
    with styled():
        figure = plt.figure(figsize=(12.8, 5.9), layout="none")
        draw_front(figure.add_axes((0.005, 0.01, 0.6, 0.92)))
        draw_side(figure.add_axes((0.605, 0.01, 0.39, 0.92)))
        figure.savefig(path, dpi=STYLE.dpi)
        plt.close(figure)


def draw_front(axes: Axes) -> None:
    """The contact plane as seen from finger 2, which is left out: pad frame, world frame, slip, chips."""
    config = load()
    pad_radius, chips = 1e3 * config.gripper.pad_radius, config.sensors.slip
    width, _, height = (1e3 * extent for extent in config.object.size)
    slip, theta = np.array([10.0, -26.0]), np.radians(12.0)

    finger(axes, (-118.0, -9.0), 106.0, 18.0)
    axes.add_patch(
        FancyBboxPatch((-142, -15), 28, 30, "round,pad=0,rounding_size=3", fc=STEEL, ec=STEEL_EDGE)
    )
    label(axes, -128, 0, "wrist", STYLE.ink, ha="center", va="center")
    axes.add_patch(Polygon(box(width, height), closed=True, fill=False, ec=WOOD_EDGE, ls=(0, (4, 3)), lw=1.0))
    turned = box(width, height) @ rotation(theta).T + slip
    axes.add_patch(Polygon(turned, closed=True, fc=WOOD, ec=WOOD_EDGE, lw=1.2, alpha=0.72))
    label(axes, -width / 2 - 3, height / 2, "object at the grasp", WOOD_EDGE, ha="right", va="top")

    axes.add_patch(Circle((0, 0), pad_radius, fc=PAD, ec="none", alpha=0.35))
    axes.add_patch(Circle((0, 0), pad_radius, fill=False, ec=PAD, lw=1.2))
    axes.add_patch(Circle((0, 0), 1e3 * chips.chip_radius, fill=False, ec=GREEN, lw=0.8, ls=":"))
    for at in 1e3 * chip_positions(chips.chip_radius, chips.chips)[: chips.chips]:
        axes.add_patch(Rectangle(at - 3.0, 6.0, 6.0, fc="white", ec=GREEN, lw=1.4, zorder=4))
    pointer(axes, "pad of finger 1,\nradius 15 mm", (14.0, 5.5), (66, 22), PAD)
    pointer(axes, "three mouse chips, 120° apart,\n24.3 mm from the centre", (24.2, -12.1), (66, -14), GREEN)

    arrow(axes, (0, 0), (52, 0), STYLE.ink)
    arrow(axes, (0, 0), (0, 52), STYLE.ink)
    label(axes, 54, 0, "x", STYLE.ink, va="center", weight="bold")
    label(axes, 0, 54, "y", STYLE.ink, ha="center", va="bottom", weight="bold")
    turn(axes, np.zeros(2), 34.0, 22.0, 62.0, STYLE.ink)
    axes.plot(0, 0, "o", color="white", mec=STYLE.ink, ms=7.5, zorder=6)
    axes.plot(0, 0, ".", color=STYLE.ink, ms=4, zorder=7)
    words = "pad frame: moves with the wrist,\nnormal towards you; theta,\nomega and tau count this way"
    pointer(axes, words, 34.0 * np.array([np.cos(0.75), np.sin(0.75)]), (66, 62), STYLE.ink)

    axes.plot(*slip, "o", color=BLUE, mec="white", ms=7, zorder=6)
    arrow(axes, (0, 0), tuple(slip), BLUE, width=2.0)
    down = np.array([0.0, -50.0])
    axes.plot(*zip(slip, slip + rotation(theta) @ down, strict=True), color=BLUE, lw=0.9)
    axes.plot(*zip(slip, slip + down, strict=True), color=BLUE, lw=0.9, ls=(0, (4, 3)))
    turn(axes, slip, 42.0, -90.0, -90.0 + np.degrees(theta), BLUE)
    label(axes, slip[0] + 11.5, slip[1] - 44.0, "theta", BLUE, va="center")
    words = "slip displacement (x, y, theta):\nof the object since the grasp,\nin the pad frame"
    pointer(axes, words, slip, (66, -60), BLUE)

    cop = np.array([-5.5, 6.0])
    axes.plot(*cop, "X", color=ORANGE, mec="white", ms=8, zorder=6)
    words = "centre of pressure (CoP):\nforces, torque and slip twist\nare taken here"
    pointer(axes, words, cop, (-138, 50), ORANGE)

    axes.plot([-110, -44], [0, 0], color=PINK, lw=0.9, ls=(0, (4, 3)))
    turn(axes, np.zeros(2), 104.0, 180.0, 196.0, PINK)
    label(axes, -94, -24, "wrist pitch, about\nthe grip axis", PINK, va="center")

    origin = (-138, -102)
    arrow(axes, origin, (-114, -102), STYLE.muted)
    arrow(axes, origin, (-138, -78), STYLE.muted)
    label(axes, -112, -102, "x", STYLE.muted, va="center")
    label(axes, -138, -76, "z, up", STYLE.muted, ha="center", va="bottom")
    label(axes, -142, -108, "world frame (y away from you)", STYLE.muted, va="top")
    arrow(axes, (-84, -68), (-84, -96), STYLE.ink, width=2.0)
    label(axes, -80, -82, "gravity", STYLE.ink, va="center")
    tidy(axes, "Front view, finger 2 left out", (-146, 144))


def draw_side(axes: Axes) -> None:
    """Both fingers as seen along the pads' x, from the wrist: grip axis, forces on the object, sensors."""
    config = load()
    radius, ring = 1e3 * config.gripper.pad_radius, 1e3 * config.sensors.slip.chip_radius
    half, height = 500.0 * config.object.size[1], 1e3 * config.object.size[2]
    axes.add_patch(Rectangle((-half, -height / 2), 2 * half, height, fc=WOOD, ec=WOOD_EDGE, lw=1.2))
    for side in (-1.0, 1.0):
        block(axes, side, (half, half + 4.0), radius, PAD, PAD, alpha=0.8)
        block(axes, side, (half + 4.0, half + 13.0), radius - 6.0, "#F7E3D4", ORANGE)
        block(axes, side, (half + 13.0, half + 32.0), 34.0, STEEL, STEEL_EDGE)
        for at in (ring, -ring / 2):
            block(axes, side, (half + 6.0, half + 13.0), 3.0, "white", GREEN, at=at)
        arrow(axes, (side * half, -2.0), (side * 1.5, -2.0), BLUE, width=2.2)
        arrow(axes, (side * (half - 2.0), -radius), (side * (half - 2.0), radius + 8.0), ORANGE, width=2.2)
        name = f"finger {1 if side < 0 else 2}"
        label(axes, side * (half + 22.5), 19.0, name, STYLE.ink, ha="center", va="center", rotation=90)
    label(axes, 0, 0, "f_n", BLUE, ha="center", va="bottom", weight="bold")
    label(axes, 0, radius + 6.0, "f_t", ORANGE, ha="center", va="center", weight="bold")
    arrow(axes, (0, -height / 4), (0, -height / 4 - 26), STYLE.ink, width=2.0)
    label(axes, 3, -height / 4 - 12, "m g", STYLE.ink, va="center")
    label(axes, 0, height / 2 + 2, "object", WOOD_EDGE, ha="center", va="bottom")

    pointer(axes, "force/torque sensor\nof each finger, 1000 Hz", (half + 9.0, 0.0), (54, 14), ORANGE)
    words = "slip-velocity sensor\nof each finger, 120 Hz:\nits chips see the\nobject's surface"
    pointer(axes, words, (half + 10.0, -ring / 2), (54, -26), GREEN)
    label(axes, -50, 66, "forces of the pads\non the object:", STYLE.ink, ha="center", va="bottom")
    label(axes, -50, 64, "f_n normal", BLUE, ha="center", va="top")
    label(axes, -50, 56, "f_t tangential", ORANGE, ha="center", va="top")

    arrow(axes, (-47, -96), (47, -96), STYLE.ink, width=1.6)
    label(
        axes,
        0,
        -100,
        "grip axis, from finger 1 to finger 2:\nthe normal of the pad frame",
        STYLE.ink,
        ha="center",
        va="top",
    )
    arrow(axes, (-66, -82), (-66, -56), STYLE.ink)
    label(axes, -66, -54, "y", STYLE.ink, ha="center", va="bottom", weight="bold")
    tidy(axes, "Side view, along x from the wrist", (-78, 110))


def box(width: float, height: float) -> np.ndarray:
    """Corners of a box about the origin, (4, 2)."""
    return 0.5 * np.array([[-width, -height], [width, -height], [width, height], [-width, height]])


def rotation(angle: float) -> np.ndarray:
    """Turns vectors by an angle [rad], (2, 2)."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def finger(axes: Axes, corner: tuple[float, float], length: float, width: float) -> None:
    """A finger seen from the side of its length."""
    style = "round,pad=0,rounding_size=4"
    axes.add_patch(FancyBboxPatch(corner, length, width, style, fc=STEEL, ec=STEEL_EDGE))


def block(
    axes: Axes, side: float, span: tuple[float, float], half: float, face: str, edge: str, **options: float
) -> None:
    """A part of one finger: between two distances from the object's middle plane, about the height `at`."""
    near, far = span
    left, at = (near if side > 0 else -far), options.pop("at", 0.0)
    axes.add_patch(Rectangle((left, at - half), far - near, 2 * half, fc=face, ec=edge, lw=1.2, **options))


def arrow(
    axes: Axes, start: tuple[float, ...], end: tuple[float, ...], colour: str, width: float = 1.4
) -> None:
    """A straight arrow."""
    style = "-|>,head_length=5,head_width=2.6"
    axes.add_patch(
        FancyArrowPatch(
            start[:2],
            end[:2],
            arrowstyle=style,
            color=colour,
            lw=width,
            shrinkA=0,
            shrinkB=0,
            zorder=5,
            mutation_scale=1.0,
        )
    )


def turn(axes: Axes, centre: np.ndarray, radius: float, first: float, last: float, colour: str) -> None:
    """An arc with a head at its end; angles in degrees."""
    axes.add_patch(
        Arc(tuple(centre), 2 * radius, 2 * radius, theta1=first, theta2=last, color=colour, lw=1.6)
    )
    end = np.radians([last - 1.0, last])
    points = np.asarray(centre)[:, None] + radius * np.array([np.cos(end), np.sin(end)])
    arrow(axes, tuple(points[:, 0]), tuple(points[:, 1]), colour, width=1.6)


def label(axes: Axes, x: float, y: float, words: str, colour: str, size: float = 8.5, **options: Any) -> None:
    """Words at a point."""
    axes.text(x, y, words, color=colour, fontsize=size, zorder=8, **options)


def pointer(
    axes: Axes, words: str, at: tuple[float, ...] | np.ndarray, where: tuple[float, float], colour: str
) -> None:
    """Words with a thin line to what they name."""
    axes.annotate(
        words,
        xy=tuple(at),
        xytext=where,
        color=colour,
        fontsize=8.5,
        va="center",
        zorder=8,
        arrowprops={"arrowstyle": "-", "color": colour, "lw": 0.8, "shrinkB": 3},
    )


def tidy(axes: Axes, title: str, x: tuple[float, float]) -> None:
    """Equal scales, no axes, a title."""
    axes.set(xlim=x, ylim=(-122, 96), aspect="equal")
    axes.set_axis_off()
    axes.set_title(title, color=STYLE.ink)


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGE)
