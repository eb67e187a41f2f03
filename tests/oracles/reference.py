"""Deliberately slow and literal oracles for the tests: the definitions in mpmath, nothing clever.

``mp.quad`` stops at an *absolute* tolerance, so every integrand is first divided by phi at its
lower end (or at 0).
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import mpmath as mp

DIGITS = 40
QUADRATURE_DIGITS = 22
mp.mp.dps = DIGITS
REACH = 13  # phi(13)/phi(0) = 2e-37
Function = Callable[[mp.mpf], mp.mpf]


def phi(s) -> mp.mpf:
    """Density of the standard normal law."""
    s = mp.mpf(s)
    return mp.exp(-s * s / 2) / mp.sqrt(2 * mp.pi)


def F(n, h) -> mp.mpf:  # noqa: N802
    """F_n(h), Eq. (2), by the parabolic cylinder function."""
    n, h = mp.mpf(n), mp.mpf(h)
    return mp.gamma(n + 1) / mp.sqrt(2 * mp.pi) * mp.exp(-h * h / 4) * mp.pcfd(-n - 1, h)


def F_star(n, h, gamma) -> mp.mpf:  # noqa: N802
    """F*_n(h), Eq. (7), by shifting the Gaussian: exp(-s) phi(s) = sqrt(e) phi(s + 1)."""
    gamma = mp.mpf(gamma)
    return gamma * F(n, h) - (gamma - 1) * mp.sqrt(mp.e) * F(n, mp.mpf(h) + 1)


def F_power(q, m: int, h, gamma) -> mp.mpf:  # noqa: N802
    """Integral of (s-h)^q (E*(s)/E*)^m phi, by the binomial theorem."""
    gamma, h = mp.mpf(gamma), mp.mpf(h)
    return mp.fsum(
        mp.binomial(m, j) * gamma ** (m - j) * (1 - gamma) ** j * mp.exp(mp.mpf(j * j) / 2) * F(q, h + j)
        for j in range(m + 1)
    )


def exponential(gamma) -> Function:
    """E*(s)/E*, Eq. (4)."""
    gamma = mp.mpf(gamma)
    return lambda s: gamma - (gamma - 1) * mp.exp(-s)


def integral(f: Function, h, *, breaks: Sequence = (), low=None, high=None) -> mp.mpf:
    """Integral of f(s) phi(s) from `low` (left out: h) to `high` (infinity), piece by piece."""
    start = mp.mpf(h if low is None else low)
    stop = mp.mpf(max(start, 0) + REACH if high is None else high)
    regular = [mp.mpf(k) * 2 for k in range(-6, 7)] + [start + k for k in (1, 3, 7)]
    inner = [mp.mpf(b) for b in [*breaks, *regular] if start < b < stop]
    scale = phi(max(start, 0))
    with mp.workdps(QUADRATURE_DIGITS):
        return scale * mp.quad(lambda s: f(s) * phi(s) / scale, sorted({start, stop, *inner}))


def graded(n, h, grading: Function, **pieces) -> mp.mpf:
    """F*_n(h) of any grading: the definition, Eqs. (3) and (7)."""
    n, h = mp.mpf(n), mp.mpf(h)
    return integral(lambda s: (s - h) ** n * grading(s), h, **pieces)


def cross(p, h1, q, h2, grading: Function) -> mp.mpf:
    """E[(s-h1)_+^p (s-h2)_+^q grading(s)], cut finely above two close separations."""
    h1, h2, p, q = mp.mpf(h1), mp.mpf(h2), mp.mpf(p), mp.mpf(q)
    top, gap = max(h1, h2), abs(h1 - h2)
    fine = [top + gap * 4**k for k in range(40) if gap * 4**k < 1]
    return integral(lambda s: (s - h1) ** p * (s - h2) ** q * grading(s), top, breaks=fine)


def cumulants_of(moments: Sequence) -> tuple:
    """First four cumulants from the first four raw moments."""
    a, b, c, d = moments
    return a, b - a**2, c - 3 * b * a + 2 * a**3, d - 4 * c * a - 3 * b**2 + 12 * b * a**2 - 6 * a**4


def pchip(x: Sequence[float], y: Sequence[float]) -> Function:
    """Monotone cubic interpolation as Fritsch and Butland (1984) define it, clamped outside."""
    x, y = [mp.mpf(v) for v in x], [mp.mpf(v) for v in y]
    step = [b - a for a, b in pairwise(x)]
    secant = [(b - a) / w for a, b, w in zip(y[:-1], y[1:], step, strict=True)]

    def end(h0, h1, d0, d1):
        slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
        if slope * d0 <= 0:
            return mp.mpf(0)
        return 3 * d0 if d0 * d1 <= 0 and abs(slope) > 3 * abs(d0) else slope

    def inner(k):
        if secant[k - 1] * secant[k] <= 0:
            return mp.mpf(0)
        w1, w2 = 2 * step[k] + step[k - 1], step[k] + 2 * step[k - 1]
        return (w1 + w2) / (w1 / secant[k - 1] + w2 / secant[k])

    last = len(x) - 1
    slope = [inner(k) if 0 < k < last else secant[0] for k in range(last + 1)]
    if last > 1:
        slope[0] = end(step[0], step[1], secant[0], secant[1])
        slope[last] = end(step[-1], step[-2], secant[-1], secant[-2])

    def value(s):
        if s <= x[0] or s >= x[-1]:
            return y[0] if s <= x[0] else y[-1]
        k = max(i for i in range(last) if x[i] <= s)
        t, w = (s - x[k]) / step[k], step[k]
        return (
            (1 + 2 * t) * (1 - t) ** 2 * y[k]
            + t * (1 - t) ** 2 * w * slope[k]
            + t**2 * (3 - 2 * t) * y[k + 1]
            + t**2 * (t - 1) * w * slope[k + 1]
        )

    return value


def error(value, truth) -> float:
    """Relative error of a double."""
    return float(abs(mp.mpf(float(value)) / truth - 1))
