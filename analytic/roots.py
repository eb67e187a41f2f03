"""Where functions change their sign: of many at once, each between two arguments; heights and separations."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints

_MOST = 200  # steps; halving from 1e3 down to the smallest room takes 70
_LAST_DIGITS = 2.0**-52
_SMALLEST = 2.0**-66  # room around 0, where numbers have no last digit


def sign_changes(
    excess: Callable[[Array, Ints], Array],
    left: Array,
    right: Array,
    unit: Array,
    *,
    at_ends: tuple[Array, Array] | None = None,
    close: float = 0.0,
) -> Array:
    """Return the arguments behind which functions have the sign that they have at `right`.

    The functions, of arguments and of their own numbers, are negative at one end and not at the other; nan is
    a negative value. To some last digits, also of the `unit` whose rounding the values have besides; where a
    function jumps past 0, right behind the jump. Values `at_ends`, where they are known, tell where to begin;
    those up to `close` count as 0.

    By Chandrupatla's rule: inverse quadratic steps where they are safe, else halves (T. R. Chandrupatla,
    Adv. Eng. Softw. 28 (1997) 145).

    >>> sign_changes(lambda x, which: x**2 - [2, 3], np.zeros(2), np.full(2, 2.0), np.ones(2)).round(12)
    array([1.41421356, 1.73205081])
    """
    active, found = np.arange(left.size), right.copy()
    fb, fa = at_ends or (excess(left, active), excess(right, active))
    step = np.clip(fa / (fa - fb), 0.05, 0.95) if at_ends else np.full(left.size, 0.5)
    a, b, c, fc, behind = right, left, left, fb, fa >= 0
    for _ in range(_MOST):
        room = np.maximum(_LAST_DIGITS * np.maximum(np.abs(a), unit), _SMALLEST)
        near = np.abs(fa) <= close
        more = (np.abs(b - a) > room) & ~near
        found[active] = np.where(((fa >= 0) == behind) | near, a, b)
        if not more.any():
            break
        active, behind = active[more], behind[more]
        unit, room, a, fa, b, fb, c, fc, step = (x[more] for x in (unit, room, a, fa, b, fb, c, fc, step))
        least = np.minimum(room / (2 * np.abs(b - a)), 0.5)
        new = a + np.clip(step, least, 1 - least) * (b - a)
        f = excess(new, active)
        same = (f >= 0) == (fa >= 0)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        a, fa, b, fb = new, f, np.where(same, b, a), np.where(same, fb, fa)
        with np.errstate(all="ignore"):
            place, value = (a - b) / (c - b), (fa - fb) / (fc - fb)
            safe = (value**2 < place) & ((1 - value) ** 2 < 1 - place)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        step = np.where(safe & np.isfinite(inverse), inverse, 0.5)
    return found


def height_between(law: Any, below: Array, above: Array) -> Array:
    """Return the heights with these probabilities on either side, by the logarithm of the smaller."""
    with np.errstate(all="ignore"):
        low, target = below < above, np.log(np.minimum(below, above))
        found, some = np.where(low, *law.support), np.isfinite(target)
        low, target = low[some], target[some]

        def excess(s: Array, which: Ints) -> Array:
            """How much more than its share is below."""
            tail, lower = np.empty(s.shape), low[which]
            tail[lower], tail[~lower] = law.cdf(s[lower]), law.sf(s[~lower])
            return np.asarray(np.where(lower, 1, -1) * (np.log(tail) - target[which]))

        (least, most), every = law.support, np.arange(target.size)
        left, right = np.full(every.shape, max(-1.0, least)), np.full(every.shape, min(1.0, most))
        while np.any(more := (left > least) & (excess(left, every) >= 0)):
            left = np.where(more, np.maximum(2 * left, least), left)
        while np.any(more := (right < most) & ~(excess(right, every) >= 0)):
            right = np.where(more, np.minimum(2 * right, most), right)
        found[some] = sign_changes(excess, left, right, np.ones(every.size))
    return np.asarray(found)


def last_separations(
    log_mean: Callable[[ArrayLike], Array], log_targets: Array, grid: Array, about: Array, name: str
) -> Array:
    """Find the largest separations at which a mean has given values, from what it is `about` at a grid."""
    targets = log_targets.ravel()
    every = np.arange(targets.size)

    def excess(h: Array, which: Ints) -> Array:  # -100 also where the mean is not positive
        return np.fmax(log_mean(h) - targets[which], -100.0)

    last = grid.size - 1
    low = np.array([np.flatnonzero(about[:last] >= target).max(initial=0) for target in targets], np.int64)
    high = low + 1
    while np.any(deeper := ((more := excess(grid[low], every)) < 0) & (low > 0)):
        low -= deeper
    while np.any(farther := ((less := excess(grid[high], every)) >= 0) & (high < last)):
        high += farther
    if np.any(more < 0) or np.any(less >= 0):
        raise ValueError(f"{name}: not reached for h from {grid[0]:g} to {grid[-1]:.4g}; give another value")
    ends, unit = (less, more), np.ones(targets.size)
    return sign_changes(excess, grid[high], grid[low], unit, at_ends=ends).reshape(log_targets.shape)
