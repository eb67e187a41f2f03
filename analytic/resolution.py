"""Where a grading varies: the heights between which it is resolved, and where it turns negative."""

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic.gradings import Grading

__all__ = ["first_negative", "resolved_breaks"]

Array = NDArray[np.float64]

_DEGREE = 16
_NODES = chebyshev.chebpts1(_DEGREE + 1)
_TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(_NODES, _DEGREE))
_TOLERANCE = 1e-14
_MOST = 4096


def _unresolved(grading: Grading, low: Array, high: Array) -> NDArray[np.bool_]:
    """Which intervals a polynomial of degree 16 does not describe to rounding error."""
    s = low[:, None] + (high - low)[:, None] * (1 + _NODES) / 2
    value = grading(s)
    size = np.abs(value).max(axis=1)
    spread = np.ptp(value, axis=1)
    # A height is only known to its last digit: a slope of spread/width turns that into noise.
    noise = 4 * np.spacing(np.abs(s).max(axis=1)) * spread / (high - low)
    tail: Array = np.abs(value @ _TO_COEFFICIENTS[-3:].T).max(axis=1)
    return np.asarray(tail > _TOLERANCE * size + noise)


def resolved_breaks(grading: Grading, low: float, high: float) -> tuple[float, ...]:
    """Heights that cut ``[low, high]`` into pieces on which the grading is a smooth curve.

    A smooth grading is cut at its own breaks; another one is bisected until a polynomial of degree
    16 describes every piece, which closes in on the jumps and kinks it did not tell.

    Parameters
    ----------
    grading : Grading
        E*(s)/E*.
    low, high : float
        Range of reduced heights that matters.

    Returns
    -------
    tuple of float
        The cuts, in increasing order, those outside the range left out.

    Raises
    ------
    ValueError
        If more than 4096 pieces are not enough.
    """
    cuts = [float(b) for b in grading.breaks if low < b < high]
    if grading.smooth or not low < high:
        return tuple(sorted(set(cuts)))
    marks = np.unique([low, *cuts, *np.arange(np.ceil(low), np.ceil(high)), high])
    left, right = marks[:-1], marks[1:]
    while left.size:
        bad = _unresolved(grading, left, right)
        middle = (left[bad] + right[bad]) / 2
        new = (middle > left[bad]) & (middle < right[bad])
        cuts.extend(middle[new].tolist())
        if len(cuts) > _MOST:
            raise ValueError(
                f"grading: not resolved by {_MOST} pieces near s = {cuts[-1]:.6g}; is it noisy? "
                "Smooth it, or give it as a table"
            )
        left, right = (
            np.concatenate([left[bad][new], middle[new]]),
            np.concatenate([middle[new], right[bad][new]]),
        )
    return tuple(np.unique([*cuts, *marks[1:-1]]).tolist())


def first_negative(grading: Grading, low: float, high: float) -> float | None:
    """First height between `low` and `high` where the modulus is negative, or None.

    Parameters
    ----------
    grading : Grading
        What to look at: at 4001 heights and next to every break.
    low, high : float
        Range of reduced heights.

    Returns
    -------
    float or None
        Lowest such height looked at.
    """
    breaks = np.asarray(grading.breaks, dtype=np.float64)
    around = np.concatenate([np.nextafter(breaks, -np.inf), breaks, np.nextafter(breaks, np.inf)])
    s = np.sort(np.concatenate([np.linspace(low, high, 4001), around[(around >= low) & (around <= high)]]))
    negative = s[grading(s) < 0]
    return float(negative[0]) if negative.size else None
