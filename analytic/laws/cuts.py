"""Where a quadrature over the heights must be cut so that terms of a contact law are smooth in between."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from analytic.gradings import Grading
from analytic.laws.branch import Branch
from analytic.laws.regimes import Regimes
from analytic.towards import NEAREST, towards

__all__ = ["cuts_of"]

Array = NDArray[np.float64]
Marks = NDArray[np.bool_]


def cuts_of(
    branches: Iterable[Branch], grading: Grading, separations: Array, low: float, high: float
) -> list[float]:
    """Ends of the regimes, and heights that shrink towards those where a broken power begins.

    Formulas that begin at the separation and are smooth in the root of s - h are so up to the end of their
    regime, or as far as the branch says. Others are made of powers of the distance from first touch or
    lift-off, or begin next to such a height: they are smooth on pieces that are no wider than some times
    that distance.

    Parameters
    ----------
    branches : iterable of Branch
        The ways to the separations.
    grading : Grading
        E*(s)/E*.
    separations : ndarray
        Reduced separations.
    low, high : float
        Range of reduced heights.

    Returns
    -------
    list of float
        In no order, some perhaps outside the range.
    """
    cuts: list[float] = []
    for branch in branches:
        regimes = branch.regimes(grading, separations, low, high)
        smooth = np.array([branch.root(j) for j in regimes.piece.tolist()], dtype=bool)
        cuts += np.unique([regimes.low, regimes.high]).tolist()
        cuts += _above_beginnings(branch, regimes, smooth, separations, low)
        cuts += _below_losses(regimes, smooth, high)
    return cuts


def _above_beginnings(branch: Branch, regimes: Regimes, smooth: Marks, h: Array, low: float) -> list[float]:
    """Towards where contact begins, and where formulas of broken powers follow smooth ones."""
    h = h[regimes.separation]
    start = np.where(regimes.low > low, regimes.low, np.minimum(h, low))
    rooted = smooth & (regimes.piece == 0) & (start == h)
    begins = np.append(True, ~_goes_on(regimes))[: smooth.size]
    rough = ~smooth & np.append(True, smooth[:-1])[: smooth.size]
    nearest = np.minimum(branch.finest, np.where(rooted, regimes.high - start, NEAREST))
    return [x for i in np.flatnonzero(begins | rough) for x in towards(float(start[i]), float(nearest[i]))]


def _below_losses(regimes: Regimes, smooth: Marks, high: float) -> list[float]:
    """Towards heights above which asperities have lost contact, under lower ones that still touch."""
    lost = np.append(~_goes_on(regimes), True)[: smooth.size] & (regimes.high < high) & ~smooth
    return [2 * end - x for end in regimes.high[lost].tolist() for x in towards(end, NEAREST)]


def _goes_on(regimes: Regimes) -> Marks:
    """Whether the next interval goes on where each one ends."""
    return np.asarray((regimes.low[1:] <= regimes.high[:-1]) & (np.diff(regimes.separation) == 0))
