"""Where a quadrature over the heights must be cut so that terms of a contact law are smooth in between."""

from collections.abc import Iterable, Sequence

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading
from analytic.laws.branch import Branch
from analytic.laws.regimes import Regimes
from analytic.quadrature import NEAREST, towards


def cuts_of(
    branches: Iterable[Branch], grading: Grading, separations: Array, low: float, high: float
) -> list[float]:
    """Ends of the regimes, and heights that shrink towards those where a broken power begins, in no order.

    Formulas that begin at the separation and are smooth in the root of s - h are so up to the end of their
    regime, or as far as the branch says. Others are made of powers of the distance from first touch or
    lift-off, or begin next to such a height: they are smooth on pieces that are no wider than some times that
    distance. Some are perhaps outside the range from `low` to `high`.
    """
    found = [cuts_of_each(branch, grading, separations, low, high)[0] for branch in branches]
    return [float(x) for x in np.unique(np.concatenate([np.empty(0), *found]))]


def cuts_of_each(
    branch: Branch, grading: Grading, separations: Array, low: float, high: float
) -> tuple[Array, Ints]:
    """The same of one branch, with repetitions, and of which separation each is."""
    regimes = branch.regimes(grading, separations, low, high)
    smooth = np.array([branch.root(j) for j in regimes.piece.tolist()], dtype=bool)
    towards_ends = _above_beginnings(branch, regimes, smooth, separations, low)
    towards_ends += _below_losses(regimes, smooth, high)
    of = regimes.separation
    heights = np.concatenate([regimes.low, regimes.high, *(x for _, x in towards_ends)])
    which = np.concatenate([of, of, *(np.full(len(x), of[i]) for i, x in towards_ends)])
    return heights, which


def _above_beginnings(
    branch: Branch, regimes: Regimes, smooth: Marks, h: Array, low: float
) -> list[tuple[int, Sequence[float]]]:
    """Towards where contact begins, and where formulas of broken powers follow smooth ones.

    Of each such interval its number, and heights.
    """
    h = h[regimes.separation]
    start = np.where(regimes.low > low, regimes.low, np.minimum(h, low))
    rooted = smooth & (regimes.piece == 0) & (start == h)
    begins = np.append(True, ~_goes_on(regimes))[: smooth.size]
    rough = ~smooth & np.append(True, smooth[:-1])[: smooth.size]
    nearest = np.minimum(branch.finest, np.where(rooted, regimes.high - start, NEAREST))
    found = np.flatnonzero(begins | rough).tolist()
    return [(i, towards(float(start[i]), float(nearest[i]))) for i in found]


def _below_losses(regimes: Regimes, smooth: Marks, high: float) -> list[tuple[int, Sequence[float]]]:
    """Towards heights above which asperities have lost contact, under lower ones that still touch."""
    lost = np.append(~_goes_on(regimes), True)[: smooth.size] & (regimes.high < high) & ~smooth
    ends = [(i, float(regimes.high[i])) for i in np.flatnonzero(lost).tolist()]
    return [(i, [2 * end - x for x in towards(end, NEAREST)]) for i, end in ends]


def _goes_on(regimes: Regimes) -> Marks:
    """Whether the next interval goes on where each one ends."""
    return np.asarray((regimes.low[1:] <= regimes.high[:-1]) & (np.diff(regimes.separation) == 0))
