"""exp(-x) in arithmetic that runs on several numbers at once, which the library's does not.

exp(-x) = 2^n exp(s) with n the whole number next to -x / ln 2 and |s| <= ln(2) / 2. x + n ln 2 is
taken in two parts of ln 2, the first short enough for an exact product (W. J. Cody, W. Waite, Software
Manual for the Elementary Functions, 1980, ch. 6). exp(s) is its Taylor polynomial of degree 13,
whose remainder is below 0.35^14 / 14! = 5e-18; its terms are summed in pairs of pairs (Estrin's scheme), as
one after the other they would wait for each other.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled

LARGEST = 40.0  # exp(-40) is below the rounding of 1
PER_LN_2 = 1.0 / math.log(2.0)
LN_2_HIGH = float.fromhex("0x1.62e42fefa0000p-1")  # 36 bits of ln 2: n times it is exact
LN_2_LOW = float.fromhex("0x1.cf79abc9e3b3ap-40")
ROUNDER = 1.5 * 2.0**52  # a number of this size holds no fraction, and a whole number in its last bits
EXPONENT_BIAS, MANTISSA_BITS = 1023, 52


@compiled
def decay(x: float) -> float:
    """exp(-x) within 1.5 units in the last place for 0 <= x < 40; 0 from there on."""
    shifted = ROUNDER - x * PER_LN_2
    n = shifted - ROUNDER
    s = -(x + n * LN_2_HIGH) - n * LN_2_LOW
    square = s * s
    fourth = square * square
    low = 0.5 + s * (1.0 / 6.0) + square * (1.0 / 24.0 + s * (1.0 / 120.0))
    middle = 1.0 / 720.0 + s * (1.0 / 5040.0) + square * (1.0 / 40320.0 + s * (1.0 / 362880.0))
    high = 1.0 / 3628800.0 + s * (1.0 / 39916800.0) + square * (1.0 / 479001600.0 + s * (1.0 / 6227020800.0))
    value = 1.0 + (s + square * (low + fourth * (middle + fourth * high)))
    bits = np.float64(shifted).view(np.int64) + EXPONENT_BIAS
    power = np.int64(bits << MANTISSA_BITS).view(np.float64)
    return power * value if x < LARGEST else 0.0
