"""Exponential, logarithm and normal law by sums, products, quotients and roots: the same bits everywhere.

The C library and NumPy have several versions of these functions and take the one that suits the processor;
their last digits differ. What is drawn must not, so the laws of heights and the gradings of this package
use these instead. All are accurate to a few units of the last digit.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np
from scipy.special import erfcx

from analytic.arrays import Array

_PIECE = 2048  # numbers at a time: they stay in the innermost cache
_LOG2_HIGH, _LOG2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10  # the first has 33 bits
TAYLOR = [1.0]
for _k in range(1, 14):
    TAYLOR.insert(0, TAYLOR[0] / _k)  # of exp, the highest power first
_PER_LOG2 = 1 / (_LOG2_HIGH + _LOG2_LOW)
PLAIN = 700.0  # up to here neither exp nor its steps overflow or lose a digit
_SMALLEST, _LARGEST = -745.2, 709.79  # beyond, exp is 0 or infinite
_HALF = np.sqrt(0.5)
_FAR = 1e4  # beyond, a density is 0


def _in_pieces(function: Callable[[Array], Array]) -> Callable[[Any], Array]:
    """Have a function of a vector take anything, in pieces that stay in the cache."""

    @wraps(function)
    def of_anything(x: Any) -> Array:
        x = np.asarray(x, dtype=np.float64)
        if x.size <= _PIECE:
            return function(x.ravel()).reshape(x.shape)
        flat, result = x.ravel(), np.empty(x.size)
        for start in range(0, x.size, _PIECE):
            result[start : start + _PIECE] = function(flat[start : start + _PIECE])
        return result.reshape(x.shape)

    return of_anything


def _polynomial(coefficients: list[float], x: Array) -> Array:
    """Horner's scheme, the highest power first."""
    value = x * coefficients[0]
    value += coefficients[1]
    for c in coefficients[2:]:
        value *= x
        value += c
    return value


def _power_of_two(k: Array) -> Array:
    """``2^k`` for whole k from -1022 to 1023."""
    return ((k.astype(np.int64) + 1023) << 52).view(np.float64)


@_in_pieces
def exp(x: Array) -> Array:
    """Exponential function of any numbers, in their shape."""
    if x.size and np.abs(x).max() < PLAIN:
        k = np.rint(x * _PER_LOG2)
        return _polynomial(TAYLOR, (x - k * _LOG2_HIGH) - k * _LOG2_LOW) * _power_of_two(k)
    with np.errstate(over="ignore", under="ignore"):
        inside = np.clip(x, _SMALLEST, _LARGEST)
        inside[np.isnan(x)] = 0.0
        k = np.rint(inside * _PER_LOG2)
        r = (inside - k * _LOG2_HIGH) - k * _LOG2_LOW
        half = np.floor(k / 2)  # in two steps, the first of which is exact
        value = _polynomial(TAYLOR, r) * _power_of_two(half) * _power_of_two(k - half)
    value[x < _SMALLEST] = 0.0
    value[x > _LARGEST] = np.inf
    value[np.isnan(x)] = np.nan
    return value


@_in_pieces
def log(x: Array) -> Array:
    """Natural logarithm of numbers >= 0, in their shape; minus infinity at 0."""
    m, k = np.frexp(x)
    low = m < _HALF
    m[low] *= 2
    k = k - low
    f = m - 1  # exact
    f[np.isinf(x)] = 0.0
    s = f / (2 + f)
    z = s * s
    series = z * _polynomial([2 / (2 * j + 1) for j in range(11, 0, -1)], z)
    # log(1 + f) = f - s (f - series): f is exact, and the rest is small
    value = np.asarray(k * _LOG2_HIGH + (f - (s * (f - series) - k * _LOG2_LOW)), dtype=np.float64)
    value[x == 0] = -np.inf
    value[x == np.inf] = np.inf
    return value


def expm1(x: Any) -> Array:
    """``exp(x) - 1``, accurate for small `x`: the error of ``exp(x)`` drops out (W. Kahan)."""
    x = np.asarray(x, dtype=np.float64)
    u = exp(x)
    with np.errstate(invalid="ignore", divide="ignore"):
        near = (u - 1) * (x / log(u))
    return np.asarray(np.where(u == 1, x, np.where(np.abs(x) < 1, near, u - 1)))


def log1p(x: Any) -> Array:
    """``log(1 + x)`` for x >= -1, accurate for small `x`: as `expm1`."""
    x = np.asarray(x, dtype=np.float64)
    u = 1 + x
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(u == 1, x, np.where(u == 0, -np.inf, log(u) * (x / (u - 1)))))


def exp_minus_half_square(h: Any) -> Array:
    """exp(-h^2/2) to full relative accuracy: the square is split so that its rounding drops out."""
    h = np.clip(np.asarray(h, dtype=np.float64), -_FAR, _FAR)
    a = np.round(16 * h) / 16
    coarse, fine = exp(np.stack([a * a, (h - a) * (h + a)]) * -0.5)
    return np.asarray(coarse * fine)


def ndtr(x: Any) -> Array:
    """Probability of a standard normal number below `x`, to full relative accuracy; in the shape of `x`."""
    x = np.asarray(x, dtype=np.float64)
    far = np.abs(x)
    tail = 0.5 * erfcx(far * _HALF) * exp_minus_half_square(np.minimum(far, 60.0))  # erfcx: series alone
    return np.asarray(np.where(x > 0, 1 - tail, tail))


# M. J. Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Appl. Statist. 37
# (1988) 477: numerators and denominators, the highest power first, in the middle, near it, and far out.
MIDDLE = (
    [2509.0809287301226727, 33430.575583588128105, 67265.770927008700853, 45921.953931549871457,
     13731.693765509461125, 1971.5909503065514427, 133.14166789178437745, 3.387132872796366608],
    [5226.495278852545925, 28729.085735721942674, 39307.89580009271061, 21213.794301586595867,
     5394.1960214247511077, 687.1870074920579083, 42.313330701600911252, 1.0],
)  # fmt: skip
NEAR = (
    [7.7454501427834140764e-4, 0.0227238449892691845833, 0.24178072517745061177, 1.27045825245236838258,
     3.64784832476320460504, 5.7694972214606914055, 4.6303378461565452959, 1.42343711074968357734],
    [1.05075007164441684324e-9, 5.475938084995344946e-4, 0.0151986665636164571966, 0.14810397642748007459,
     0.68976733498510000455, 1.6763848301838038494, 2.05319162663775882187, 1.0],
)  # fmt: skip
OUT = (
    [2.01033439929228813265e-7, 2.71155556874348757815e-5, 0.0012426609473880784386, 0.026532189526576123093,
     0.29656057182850489123, 1.7848265399172913358, 5.4637849111641143699, 6.6579046435011037772],
    [2.04426310338993978564e-15, 1.4215117583164458887e-7, 1.8463183175100546818e-5,
     7.868691311456132591e-4, 0.0148753612908506148525, 0.13692988092273580531, 0.59983220655588793769, 1.0],
)  # fmt: skip


def _ratio(table: tuple[list[float], list[float]], x: Array) -> Array:
    return _polynomial(table[0], x) / _polynomial(table[1], x)


@_in_pieces
def ndtri(p: Array) -> Array:
    """Standard normal number below which the share `p` lies, in the shape of `p`; infinite at 0 and 1."""
    q = p - 0.5
    value = q * _ratio(MIDDLE, 0.180625 - q * q)
    outer = np.flatnonzero(np.abs(q) > 0.425)
    if outer.size:
        tail = np.minimum(p[outer], 1 - p[outer])
        root = np.sqrt(-log(tail))
        with np.errstate(invalid="ignore"):
            size = np.where(root <= 5, _ratio(NEAR, root - 1.6), _ratio(OUT, root - 5))
        value[outer] = np.copysign(np.where(tail > 0, size, np.inf), q[outer])
    return value
