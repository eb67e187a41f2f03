"""What pieces of a contact law mean for integrals over the heights.

Where a quadrature must be cut so that terms are smooth in between; and how fast sums grow when a surface
comes nearer: within the pieces, and where pieces change.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading
from analytic.laws.branch import Branch
from analytic.laws.law import piece_of
from analytic.laws.regimes import Bound, Regimes, crossings_of, limit_of
from analytic.laws.unloading import slope_in_root
from analytic.quadrature import NEAREST, towards
from analytic.quantities import quantity_of


def cuts_of(
    branches: Iterable[Branch], grading: Grading, separations: Array, low: float, high: float
) -> list[float]:
    """Return ends of regimes, and heights that shrink towards those where a broken power begins, unsorted.

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
    """Return the same of one branch, with repetitions, and of which separation each is."""
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
    begins = ~regimes.goes_on[:-1]
    rough = ~smooth & np.append(True, smooth[:-1])[: smooth.size]
    nearest = np.minimum(branch.finest, np.where(rooted, regimes.high - start, NEAREST))
    found = np.flatnonzero(begins | rough).tolist()
    return [(i, towards(float(start[i]), float(nearest[i]))) for i in found]


def _below_losses(regimes: Regimes, smooth: Marks, high: float) -> list[tuple[int, Sequence[float]]]:
    """Towards heights above which asperities have lost contact, under lower ones that still touch."""
    lost = ~regimes.goes_on[1:] & (regimes.high < high) & ~smooth
    ends = [(i, float(regimes.high[i])) for i in np.flatnonzero(lost).tolist()]
    return [(i, [2 * end - x for x in towards(end, NEAREST)]) for i, end in ends]


_TOUCH = 1e-60  # root of the penetration at first touch: at 0 itself slopes are 0/0
_NEAR = 2.0**-28  # heights on either side, from which the slope of a bound is taken


def slope_term(quantity: str, branch: Branch, penetration: Array, e: Array) -> Array:
    """Return the derivative by the penetration of what asperities add, within a piece; 0 without contact.

    Of reduced penetrations s - h, negative without contact, and moduli E*(s)/E*, in their common shape.
    """
    piece = np.where(penetration > 0, piece_of(branch.law, penetration, e), -1)
    penetration, e = (np.broadcast_to(x, piece.shape) for x in (penetration, e))
    result = np.zeros(piece.shape)
    for j in range(int(piece.max(initial=-1)) + 1):
        here = piece == j
        of_root = partial(branch.of_some(here).of_root, quantity, j, e=e[here])
        result[here] = slope_in_root(of_root, np.sqrt(penetration[here]))
    return result


@dataclass(frozen=True)
class Jumps:
    """Asperities that go on to the next piece of a law where the surface comes nearer.

    An asperity of height t does so when the separation is that at which ``t - h = limit(e(t))``. As the
    surface comes nearer by dh, those of a range of ``dh/abs(1 - d limit/dt)`` heights do.

    Parameters
    ----------
    branch : Branch
        Of these asperities.
    piece : int
        Number of the piece that they leave; -1 at first touch.
    root, modulus, share : ndarray
        Root of the penetration, E*(s)/E*, and the share of asperities for each unit of the separation.
    separation : ndarray of int
        Which of the separations; all of shape (jumps,).
    ratios : ndarray, optional
        Radii of the summits over that of the surface, where they differ.
    """

    branch: Branch
    piece: int
    root: Array
    modulus: Array
    share: Array
    separation: Ints
    ratios: Array | None = None

    def before(self, quantity: str) -> Array:
        """Return what they add before, over the scale."""
        if self.piece < 0:
            return np.zeros(self.root.shape)
        return self._by_radius(quantity) * self.branch.of_root(quantity, self.piece, self.root, self.modulus)

    def step(self, quantity: str) -> Array:
        """By how much what they add jumps."""
        after = self.branch.of_root(quantity, self.piece + 1, self.root, self.modulus)
        return self._by_radius(quantity) * after - self.before(quantity)

    def _by_radius(self, quantity: str) -> Array:
        return np.asarray(1.0 if self.ratios is None else self.ratios ** quantity_of(quantity).radius)


def jumps_met(
    branch: Branch,
    grading: Grading,
    density: Callable[[Array, Ints], Array],
    separations: Array,
    ends: tuple[float, float],
) -> Iterator[Jumps]:
    """Yield the asperities that jump between two heights: those that touch, then piece by piece.

    `density` is that of heights and of the numbers of their separations, which have the radii of the law in
    turn.
    """
    law, every = branch.law, np.arange(separations.size)
    touch = np.full(separations.shape, _TOUCH)
    share = density(separations, every)
    yield Jumps(branch.of_some(every), -1, touch, grading(separations), share, every)
    for j in range(len(law.limits(np.ones(law.radii)))):
        bound = limit_of(law, grading, j)
        found = crossings_of(bound, grading, separations, *ends, law.radii)
        s, which = found.height, found.separation
        root = np.sqrt(np.maximum(s - separations[which], 0.0))
        shares = density(s, which) * _moved(bound, s, which)
        yield Jumps(branch.of_some(which), j, root, grading(s), shares, which)


def _moved(bound: Bound, heights: Array, which: Ints) -> Array:
    """How far heights where a piece begins move for each unit of separation: not where the bound jumps."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        rise = bound(heights + _NEAR, which) - bound(heights - _NEAR, which)
        return np.nan_to_num(1 / np.abs(1 - rise / (2 * _NEAR)))
