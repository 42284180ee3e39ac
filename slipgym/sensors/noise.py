"""Generates standard normal numbers by key and index, without the state of a generator.

A counter-based generator: the index-th output of SplitMix64 (Steele, Lea & Flood, Fast splittable
pseudorandom number generators, 2014) started at the key, put through the inverse of the normal
distribution (Wichura, Algorithm AS 241: the percentage points of the normal distribution, 1988), which
a table of cubics stands for but in the tails.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_S30, _S27, _S31, _S11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)
_ONE = np.uint64(1)
CELLS = 1024
"""Parts of (0, 1) that have a cubic each."""
TAIL = 16
"""Of these, how many at either end have none, where the curve is steep."""


@compiled
def uniform(key: int, index: int) -> float:
    """The number of an index >= 0 and a uint64 key, in (0, 1), a multiple of 2^-53 plus half of one."""
    x = key + (np.uint64(index) + _ONE) * _GOLDEN
    x = (x ^ (x >> _S30)) * _MIX_1
    x = (x ^ (x >> _S27)) * _MIX_2
    x = x ^ (x >> _S31)
    return (np.float64(np.int64(x >> _S11)) + 0.5) * 2.0**-53


@compiled
def standard_normal(key: int, index: int) -> float:
    """The index-th standard normal number of a key; see `uniform`."""
    return interpolated(uniform(key, index))


@compiled
def interpolated(p: float) -> float:
    """`quantile` to 1e-7, in a third of its time; exact in the tails."""
    place = CELLS * p
    k = int(place)
    if not TAIL <= k < CELLS - TAIL:
        return quantile(p)
    rest = place - k
    cubic = _CUBICS[k]
    return ((cubic[3] * rest + cubic[2]) * rest + cubic[1]) * rest + cubic[0]


@compiled
def quantile(p: float) -> float:
    """Value that a standard normal number stays below with probability p in (0, 1), to 1e-15 (AS 241)."""
    q = p - 0.5
    if abs(q) <= 0.425:
        r = 0.180625 - q * q
        numerator = (
            ((2509.0809287301226727 * r + 33430.575583588128105) * r + 67265.770927008700853) * r
            + 45921.953931549871457
        ) * r + 13731.693765509461125
        numerator = ((numerator * r + 1971.5909503065514427) * r + 133.14166789178437745) * r
        denominator = (
            ((5226.495278852545925 * r + 28729.085735721942674) * r + 39307.89580009271061) * r
            + 21213.794301586595867
        ) * r + 5394.1960214247511077
        denominator = ((denominator * r + 687.1870074920579083) * r + 42.313330701600911252) * r
        return q * (numerator + 3.387132872796366608) / (denominator + 1.0)
    r = math.sqrt(-math.log(p if q < 0.0 else 1.0 - p))
    if r <= 5.0:
        r -= 1.6
        numerator = (
            ((7.7454501427834140764e-4 * r + 0.0227238449892691845833) * r + 0.24178072517745061177) * r
            + 1.27045825245236838258
        ) * r + 3.64784832476320460504
        numerator = ((numerator * r + 5.7694972214606914055) * r + 4.6303378461565452959) * r
        denominator = (
            ((1.05075007164441684324e-9 * r + 5.475938084995344946e-4) * r + 0.0151986665636164571966) * r
            + 0.14810397642748007459
        ) * r + 0.68976733498510000455
        denominator = ((denominator * r + 1.6763848301838038494) * r + 2.05319162663775882187) * r
        value = (numerator + 1.42343711074968357734) / (denominator + 1.0)
    else:
        r -= 5.0
        numerator = (
            ((2.01033439929228813265e-7 * r + 2.71155556874348757815e-5) * r + 0.0012426609473880784386) * r
            + 0.026532189526576123093
        ) * r + 0.29656057182850489123
        numerator = ((numerator * r + 1.7848265399172913358) * r + 5.4637849111641143699) * r
        denominator = (
            ((2.04426310338993978564e-15 * r + 1.4215117583164458887e-7) * r + 1.8463183175100546818e-5) * r
            + 7.868691311456132591e-4
        ) * r + 0.0148753612908506148525
        denominator = ((denominator * r + 0.13692988092273580531) * r + 0.59983220655588793769) * r
        value = (numerator + 6.6579046435011037772) / (denominator + 1.0)
    return -value if q < 0.0 else value


def _cubics() -> np.ndarray:
    """Coefficients (CELLS, 4) of the cubics that have value and slope of the quantile at both ends."""
    cubics = np.zeros((CELLS, 4))
    inner = np.arange(TAIL, CELLS - TAIL + 1)
    value = np.array([quantile.py_func(k / CELLS) for k in inner.tolist()])
    slope = np.array([math.sqrt(math.tau) * math.exp(0.5 * x * x) / CELLS for x in value.tolist()])
    rise = np.diff(value)
    cubics[TAIL : CELLS - TAIL] = np.column_stack(
        [
            value[:-1],
            slope[:-1],
            3.0 * rise - 2.0 * slope[:-1] - slope[1:],
            slope[:-1] + slope[1:] - 2.0 * rise,
        ]
    )
    return cubics


_CUBICS = _cubics()
