"""Fills triangles: the one compiled part of the renderer."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def fill(corners, colours, image, nearness):
    """Draw triangles in their order; those that face away are left out.

    Args:
        corners: (n, 3, 3): x to the right and y down [samples], nearness 1/depth [1/m]; a
            corner behind the camera has nearness <= 0 and hides its triangle.
        colours: (n, 4): red, green and blue in 0 to 255, opacity in 0 to 1.
        image: (height, width, 3) uint8, blended into.
        nearness: (height, width): of what is drawn so far; opaque triangles update it.
    """
    height, width = nearness.shape
    for i in range(corners.shape[0]):
        (ax, ay, an), (bx, by, bn), (cx, cy, cn) = corners[i]
        area = (cx - ax) * (by - ay) - (bx - ax) * (cy - ay)
        if area <= 0.0 or min(an, bn, cn) <= 0.0:
            continue
        red, green, blue, opacity = colours[i]
        left, right = max(0.0, min(ax, bx, cx)), min(width - 1.0, max(ax, bx, cx))
        top, bottom = max(0.0, min(ay, by, cy)), min(height - 1.0, max(ay, by, cy))
        for row in range(int(top), int(bottom) + 1):
            y = row + 0.5
            for column in range(int(left), int(right) + 1):
                x = column + 0.5
                a = ((cx - bx) * (y - by) - (cy - by) * (x - bx)) / -area
                b = ((ax - cx) * (y - cy) - (ay - cy) * (x - cx)) / -area
                c = 1.0 - a - b
                near = a * an + b * bn + c * cn
                if a < 0.0 or b < 0.0 or c < 0.0 or near <= nearness[row, column]:
                    continue
                pixel = image[row, column]
                pixel[0] = round(pixel[0] + opacity * (red - pixel[0]))
                pixel[1] = round(pixel[1] + opacity * (green - pixel[1]))
                pixel[2] = round(pixel[2] + opacity * (blue - pixel[2]))
                if opacity >= 1.0:
                    nearness[row, column] = near


@njit(cache=True)
def shrink(image, picture):
    """Average 2 by 2 samples (2 h, 2 w, 3) into a picture (h, w, 3), both uint8."""
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            for k in range(3):
                r, c = 2 * row, 2 * column
                upper = np.int64(image[r, c, k]) + np.int64(image[r, c + 1, k])
                lower = np.int64(image[r + 1, c, k]) + np.int64(image[r + 1, c + 1, k])
                picture[row, column, k] = (upper + lower + 2) // 4
