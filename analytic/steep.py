"""How far heights count where a grading rises, or the density of the heights falls, as nobody knows."""

from collections.abc import Callable

import numpy as np

from analytic.arrays import Array
from analytic.gradings import Exponential, Grading, Homogeneous
from analytic.tables import Table

_LOST = 40.0  # logarithm of the weight lost outside: 4e-18 of its largest value
_STEP = 1.25
_MOST = 400  # steps: 1e38 times as far
_ALONG = np.union1d(np.linspace(0, 1, 65), np.geomspace(1e-4, 1, 65))


def tame(grading: Grading) -> bool:
    """Whether it is known to rise no faster than ``exp(-s)``, of which the normal law makes nothing."""
    inner = getattr(grading, "grading", grading)
    return isinstance(inner, Homogeneous | Exponential | Table)


def reach(
    log_density: Callable[[Array], Array],
    grading: Grading,
    start: float,
    end: float,
    limit: float,
    *,
    power: float,
    exponent: float = 0.0,
) -> float:
    """Return the height beyond which an integral has nothing left.

    Parameters
    ----------
    log_density : callable
        Logarithm of the density at an array of heights.
    grading : Grading
        E*(s)/E*.
    start, end, limit : float
        The answer is `end`, or as much farther from `start` as it takes, either way; never beyond `limit`.
    power : float
        Of the modulus in the integral.
    exponent : float, optional
        Of the distance from the start.

    Raises
    ------
    ValueError
        If the integrand does not fall, or the modulus is then beyond double precision.
    """
    steepest = 700.0 - 25.0 * power  # leaves room for the power of the approach
    found = end
    for _ in range(_MOST):
        far = abs(found - start) * _ALONG
        s = start + np.sign(found - start) * far
        s[-1] = found
        with np.errstate(divide="ignore"):
            modulus = power * np.log(np.abs(grading(s)))
        weight = log_density(s) + modulus + exponent * np.log1p(far)
        if found == limit or not weight[-1] > weight.max() - _LOST:
            if found == end or modulus.max() < steepest:
                return found
            break
        if modulus.max() > steepest:
            break
        found = start + _STEP * (found - start)
        found = min(found, limit) if start < limit else max(found, limit)
    raise ValueError(
        f"grading: up to s = {found:.4g} E*(s)/E* increases too steeply, or the tail of the heights is "
        "too heavy, for a mean and a variance in double precision; let the grading level off"
    )
