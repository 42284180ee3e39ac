"""Rasterises filled triangles and smooth lines, in compiled code."""

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


@compiled
def shrink(image, picture):
    """Average 2 by 2 samples (2 h, 2 w, 3) into a picture (h, w, 3), both uint8."""
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            r, c = 2 * row, 2 * column
            for k in range(3):
                upper = int(image[r, c, k]) + int(image[r, c + 1, k])
                lower = int(image[r + 1, c, k]) + int(image[r + 1, c + 1, k])
                picture[row, column, k] = (upper + lower + 2) // 4


@compiled
def stroke(points, width, dash, mask):
    """Draw a smooth line with round ends; a point that is not finite breaks it.

    Args:
        points: (n, 2): x to the right and y down [pixels].
        width: [pixels].
        dash: Length of dashes and gaps along x, for lines that run to the right [pixels]; 0 for none.
        mask: (height, width): coverage 0 to 1; where lines cross, the larger stays.
    """
    height, breadth = mask.shape
    reach = 0.5 * width + 0.5
    for i in range(points.shape[0] - 1):
        ax, ay, bx, by = points[i, 0], points[i, 1], points[i + 1, 0], points[i + 1, 1]
        if not math.isfinite(ax + ay + bx + by):
            continue
        dx, dy = bx - ax, by - ay
        square = max(dx * dx + dy * dy, 1e-12)
        top, bottom = max(0, int(min(ay, by) - reach)), min(height - 1, int(max(ay, by) + reach))
        low, high = min(ax, bx) - reach, max(ax, bx) + reach
        for row in range(top, bottom + 1):
            y = row + 0.5 - ay
            left, right = low, high
            if abs(dy) > 1e-6:  # no more of the row than the line's own breadth
                middle, half = ax + y * dx / dy, reach * math.sqrt(square) / abs(dy)
                left, right = max(left, middle - half), min(right, middle + half)
            for column in range(max(0, int(left)), min(breadth - 1, int(right)) + 1):
                x = column + 0.5 - ax
                along = min(max((x * dx + y * dy) / square, 0.0), 1.0)
                if dash > 0.0 and int((ax + along * dx) / dash) % 2 == 1:
                    continue
                ex, ey = x - along * dx, y - along * dy
                away = math.sqrt(ex * ex + ey * ey)
                mask[row, column] = max(mask[row, column], min(1.0, reach - away))


@compiled
def tint(picture, mask, colour):
    """Blend one colour into a picture (h, w, 3) uint8 where a mask (h, w) in 0 to 1 covers it."""
    for row in range(mask.shape[0]):
        for column in range(mask.shape[1]):
            cover = mask[row, column]
            if cover > 0.0:
                for k in range(3):
                    old = picture[row, column, k]
                    picture[row, column, k] = round(old + cover * (colour[k] - old))
