"""A formula of one piece of a law as a Chebyshev series: what is left of it once it lies in a file."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

__all__ = ["RootSeries", "resolved_in_root"]

_MOST_TERMS = 256
_NOTHING = 1e-16  # of the largest value
_ALLOWED = 1e-13
_BETWEEN = np.linspace(-1, 1, 301)


@dataclass(frozen=True)
class RootSeries:
    """``u^2`` times a Chebyshev series, in the root u of a penetration.

    Parameters
    ----------
    low, high : float
        Between which the series was made. If `low` is ``-high``, around first touch, its variable is
        u/high; else ``(u - g)/(u + g)`` with ``g = sqrt(low high)``, which sees wide pieces evenly.
    coefficients : sequence of float
        Of T_0, T_1, ... in that variable, stretched to -1..1.
    """

    low: float
    high: float
    coefficients: tuple[float, ...]

    def __call__(self, u: Any) -> Any:
        """Its values, for real and complex u, also slightly outside."""
        return u * u * chebyshev.chebval(_variable(u, self.low, self.high), np.array(self.coefficients))

    def agrees(self, other: "RootSeries") -> bool:
        """Whether another series has the same values, to 1e-13 of the largest."""
        between = _at(_BETWEEN[_BETWEEN != 0], self.low, self.high)
        mine, theirs = self(between), other(between)
        near = np.allclose([self.low, self.high], [other.low, other.high], rtol=_ALLOWED)
        return bool(near and np.all(np.abs(mine - theirs) <= _ALLOWED * np.abs(mine).max()))


def _variable(u: Any, low: float, high: float) -> Any:
    if low == -high:
        return u / high
    middle = np.sqrt(low * high)
    return (u - middle) / (u + middle) * ((high + middle) / (high - middle))


def _at(t: Any, low: float, high: float) -> Any:
    """Where the variable has this value."""
    if low == -high:
        return t * high
    middle = np.sqrt(low * high)
    t = t * ((high - middle) / (high + middle))
    return middle * (1 + t) / (1 - t)


def resolved_in_root(formula: Callable[[Any], Any], low: float, high: float) -> RootSeries:
    """The series that stands for a formula, to 1e-13 of the largest value of ``formula/u^2``.

    Raises
    ------
    ValueError
        If 256 terms are not enough.
    """
    for terms in (16, 32, 64, 128, _MOST_TERMS):
        nodes = chebyshev.chebpts1(terms)
        u = _at(nodes, low, high)
        c = 2 / terms * (chebyshev.chebvander(nodes, terms - 1).T @ (formula(u) / (u * u)))
        c[0] /= 2
        c[np.abs(c) <= _NOTHING * np.abs(c).max()] = 0  # so that what is even or odd stays it
        found = RootSeries(low, high, tuple(np.trim_zeros(c, "b").tolist()))
        between = _at(_BETWEEN[_BETWEEN != 0], low, high)
        over = (found(between) - formula(between)) / between**2
        if np.all(np.abs(over) <= _ALLOWED * np.abs(c).max()):
            return found
    first = "; where it begins, write u**3 for (u*u)**1.5, as it is asked at -u too" if low < 0 else ""
    raise ValueError(
        f"{_MOST_TERMS} terms of a series are not enough for it between x = {low * abs(low):g} and "
        f"{high * high:g}: give the penetration of each jump and kink in limits{first}"
    )
