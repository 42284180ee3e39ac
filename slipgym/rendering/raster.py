"""Rasterises filled triangles in compiled code.

It needs no GL, takes milliseconds and gives the same picture on every machine.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled


@compiled
def fill(corners, colours, image, nearness):
    """Draw triangles in their order; triangles that face away are left out.

    Args:
        corners: (n, 3, 3): x to the right and y down [samples], nearness 1/depth [1/m]; a
            corner behind the camera has nearness <= 0 and hides its triangle.
        colours: (n, 4): red, green and blue in 0 to 255, opacity in 0 to 1.
        image: (height, width, 3) uint8, blended into.
        nearness: (height, width): nearness of the triangles drawn so far; opaque triangles update it.
    """
    height, width = nearness.shape
    for i in range(corners.shape[0]):
        (ax, ay, an), (bx, by, bn), (cx, cy, cn) = corners[i]
        area = (cx - ax) * (by - ay) - (bx - ax) * (cy - ay)
        if area <= 0.0 or min(an, bn, cn) <= 0.0:
            continue
        red, green, blue, opacity = colours[i]
        top, bottom = max(0.0, min(ay, by, cy)), min(height - 1.0, max(ay, by, cy))
        for row in range(int(top), int(bottom) + 1):
            y = row + 0.5
            left, right = max(0.0, min(ax, bx, cx)), min(width - 0.5, max(ax, bx, cx))
            near, slope = 0.0, 0.0  # nearness in this row: near + slope x
            for px, py, qx, qy, n in ((bx, by, cx, cy, an), (cx, cy, ax, ay, bn), (ax, ay, bx, by, cn)):
                # weight of the corner across the edge p q: start + rise x
                rise = (qy - py) / area
                start = ((qx - px) * (py - y) - (qy - py) * px) / area
                near, slope = near + n * start, slope + n * rise
                if rise > 0.0:
                    left = max(left, -start / rise)
                elif rise < 0.0:
                    right = min(right, -start / rise)
                elif start < 0.0:
                    right = -1.0
            for column in range(math.ceil(left - 0.5), math.floor(right - 0.5) + 1):
                here = near + slope * (column + 0.5)
                if here <= nearness[row, column]:
                    continue
                pixel = image[row, column]
                pixel[0] = round(pixel[0] + opacity * (red - pixel[0]))
                pixel[1] = round(pixel[1] + opacity * (green - pixel[1]))
                pixel[2] = round(pixel[2] + opacity * (blue - pixel[2]))
                if opacity >= 1.0:
                    nearness[row, column] = here
