"""The ways a surface can have gone: loading, and unloading from the lowest separation it reached.

A branch says at which heights which formula holds, and gives the formulas at heights above the separation.
So everything that sums over asperities treats loading, unloading and any law of contact alike.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Custom, Grading, Homogeneous
from analytic.laws.crossings import crossings_of
from analytic.laws.film import SpotConductance
from analytic.laws.law import ContactLaw
from analytic.laws.regimes import Regimes, merged_heights, regimes_of
from analytic.laws.spot import of_spot, of_unloading, piece_of

__all__ = ["Branch", "LoadingBranch", "UnloadingBranch", "term_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


class Branch(Protocol):
    """A way that a surface can have gone to a separation."""

    @property
    def finest(self) -> float:
        """How far above first touch formulas are analytic."""
        ...

    def lowest(self, h: float) -> float:
        """Height below which nothing touches, at a separation or at higher ones."""
        ...

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """At which heights there is contact, and which formula holds there."""
        ...

    def root(self, piece: int) -> bool:
        """Whether a contact of this piece is analytic in the root of the penetration where it begins."""
        ...

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """Penetration left until contact is lost, whose root the formulas take."""
        ...

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """Which formula holds at heights `above` the separations, -1 without contact."""
        ...

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0
    ) -> Array:
        """What contacts of a piece add at heights `above` the separations, over the scale.

        With a `sign` of -1 the formula goes on to negative roots of the penetration.
        """
        ...


@dataclass(frozen=True)
class LoadingBranch:
    """The surface comes closer, or has never been closer.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    conductance : SpotConductance, optional
        Of "conductance_si".
    """

    law: ContactLaw
    conductance: SpotConductance | None = None

    @property
    def finest(self) -> float:
        """As `Branch.finest`."""
        return min(self.law.finest, self.conductance.finest) if self.conductance else self.law.finest

    def lowest(self, h: float) -> float:
        """As `Branch.lowest`."""
        return h

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """As `Branch.regimes`."""
        return regimes_of(self.law, grading, separations, low, high)

    def root(self, piece: int) -> bool:
        """As `Branch.root`."""
        return piece > 0 or self.law.root

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """As `Branch.left`."""
        return above

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """As `Branch.pieces`."""
        return np.where(above > 0, piece_of(self.law, above, e), -1)

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0
    ) -> Array:
        """As `Branch.value`."""
        return self.of_root(quantity, piece, sign * np.sqrt(above), e)

    def of_some(self, which: NDArray[np.bool_]) -> "LoadingBranch":
        """That of some of the summits that the law was made for; as it is where all have one radius."""
        conductance = None if self.conductance is None else self.conductance.of_some(which)
        return LoadingBranch(self.law.of_some(which), conductance)

    def of_root(self, quantity: str, piece: int, y: Any, e: Array) -> Array:
        """The same of the root of the penetration, which may be complex."""
        if quantity == "conductance_si":
            return _conducted(self.conductance, self.of_root("conductance", piece, y, e))
        return of_spot(quantity, self.law, piece, y, e)


@dataclass(frozen=True)
class UnloadingBranch:
    """The surface goes back from the lowest separation it has reached.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    deepest : float
        That separation, d/sigma.
    conductance : SpotConductance, optional
        Of "conductance_si".
    """

    law: ContactLaw
    deepest: float
    conductance: SpotConductance | None = None

    @property
    def finest(self) -> float:
        """As `Branch.finest`."""
        return LoadingBranch(self.law, self.conductance).finest

    def lowest(self, h: float) -> float:
        """As `Branch.lowest`: what has touched may stick."""
        return self.deepest

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """As `Branch.regimes`: pieces are those of the deepest penetration."""
        h = np.asarray(separations, dtype=np.float64)
        turn = regimes_of(self.law, grading, [self.deepest], low, high)
        if not turn.low.size:
            return turn
        kinks = tuple(float(s) for s in turn.low)
        bent = grading if isinstance(grading, Homogeneous) else Custom(grading, (*grading.breaks, *kinks))
        lost = crossings_of(lambda s: self._residual(s, grading(s)), bent, h, low, high)
        height = merged_heights(lost.height, h[lost.separation], h)
        found = [
            self._intervals(k, turn, height[lost.separation == k], low, high, self._touches(x, low, grading))
            for k, x in enumerate(h.tolist())
        ]
        return Regimes(*(np.concatenate(part) for part in zip(*found, strict=True)))

    def _intervals(
        self, separation: int, turn: Regimes, crossings: Array, low: float, high: float, touches: bool
    ) -> tuple[Ints, Array, Array, Ints]:
        """Pieces of the deepest penetration, where there is contact."""
        edges = np.unique([low, *crossings, *turn.low, high])
        begin, end = edges[:-1], edges[1:]
        contact = touches ^ (np.searchsorted(crossings, begin, side="right") % 2 == 1)
        where = np.searchsorted(turn.low, begin, side="right") - 1
        held = contact & (where >= 0)
        return np.full(held.sum(), separation), begin[held], end[held], turn.piece[where[held]]

    def _touches(self, h: float, s: float, grading: Grading) -> bool:
        """Whether the lowest height there is touches."""
        at = np.array([s])
        return bool(s - h >= self._residual(at, grading(at))[0])

    def _residual(self, s: Array, e: Array) -> Array:
        """Penetration at which an asperity is lost; infinite where it was never in contact."""
        deepest = s - self.deepest
        piece, result = piece_of(self.law, deepest, e), np.zeros(np.shape(s))
        for j in np.unique(piece):
            here = piece == j
            result[here] = self.law.of_some(here).unloading().residual(int(j), deepest[here], e[here])
        return np.where(deepest >= 0, result, np.inf)

    def root(self, piece: int) -> bool:
        """As `Branch.root`."""
        return self.law.root if piece == 0 else self.law.unloading().root

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """As `Branch.left`."""
        return above - self._residual(h + above, e)

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """As `Branch.pieces`."""
        above, h, e = np.broadcast_arrays(above, h, e)
        s = h + above
        piece = piece_of(self.law, above + (h - self.deepest), e)
        return np.where(above > self._residual(s, e), piece, -1)

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0
    ) -> Array:
        """As `Branch.value`."""
        if quantity == "conductance_si":
            return _conducted(self.conductance, self.value("conductance", piece, h, above, e, sign=sign))
        unloading, deepest = self.law.unloading(), above + (h - self.deepest)
        y = sign * np.sqrt(np.maximum(above - unloading.residual(piece, deepest, e), 0.0))
        return of_unloading(quantity, unloading, piece, y, deepest, e)


def _conducted(conductance: SpotConductance | None, radius: Array) -> Array:
    if conductance is None:
        raise ValueError("conductance_si: give a resistivity")
    return conductance(radius)


def term_of(quantity: str, branch: Branch, h: ArrayLike, heights: ArrayLike, e: ArrayLike) -> Array:
    """What asperities add at a separation, 0 without contact: literally, each by its own formula.

    Parameters
    ----------
    quantity : str
        Its name: one of `analytic.QUANTITIES` or `analytic.LAW_QUANTITIES`.
    branch : Branch
        The way to the separation.
    h, heights, e : array_like
        Reduced separations and heights, and moduli E*(s)/E* at the heights, of any shapes that broadcast.

    Returns
    -------
    ndarray
        In their common shape, over the quantity's scale.
    """
    h, s, e = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (h, heights, e)))
    above, result = s - h, np.zeros(s.shape)
    pieces = branch.pieces(h, above, e)
    for piece in np.unique(pieces[pieces >= 0]).tolist():
        here = pieces == piece
        result[here] = branch.value(quantity, piece, h[here], above[here], e[here])
    return result
