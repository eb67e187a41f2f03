"""History of a surface: loading, and unloading from the lowest separation that it reached.

A branch says at which heights which formula holds, and gives the formulas at heights above the separation.
So everything that sums over asperities treats loading, unloading and any law of contact alike.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array, Ints
from analytic.gradings import Grading
from analytic.laws.film import SpotConductance
from analytic.laws.law import ContactLaw, of_spot, piece_of
from analytic.laws.regimes import Bound, Regimes, crossings_of, limit_of, regimes_between
from analytic.laws.unloading import Unloading, slope_in_root
from analytic.quantities import quantity_of


@dataclass(frozen=True)
class Branch:
    """Branch on which a surface reaches a separation: loading, or unloading from the lowest one.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    conductance : SpotConductance, optional
        Of "conductance_si".
    deepest : float, optional
        Lowest separation that an unloaded surface has reached, d/sigma.
    """

    law: ContactLaw
    conductance: SpotConductance | None = None
    deepest: float | None = None

    @property
    def finest(self) -> float:
        """How far above first touch formulas are analytic."""
        return min(self.law.finest, self.conductance.finest) if self.conductance else self.law.finest

    def with_radii(self, ratios: Array) -> Self:
        """Return that of summits whose radii are these multiples of the surface's, one a separation."""
        own = None if self.conductance is None else self.conductance.with_radii(ratios)
        return replace(self, law=self.law.with_radii(ratios), conductance=own)

    def of_some(self, which: NDArray[Any]) -> Self:
        """Return the law of selected summits; itself where all have one radius."""
        own = None if self.conductance is None else self.conductance.of_some(which)
        return replace(self, law=self.law.of_some(which), conductance=own)

    def lowest(self, h: Any) -> Any:
        """Height below which nothing touches, at a separation or at higher ones, in its shape."""
        return h if self.deepest is None else self.deepest

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """At which heights there is contact, and which formula holds there.

        Under a law of several radii (`ContactLaw.with_radii`) separations have these in turn.
        """
        h = np.asarray(separations, dtype=np.float64)
        start = np.broadcast_to(np.maximum(self.lowest(h), low), h.shape)
        found = [
            crossings_of(bound, grading, level, low, high, self.law.radii)
            for level, bound in self.beginnings(grading, h)
        ]

        def piece(s: Array, which: Ints) -> Ints:
            return self.of_some(which).pieces(h[which], s - h[which], grading(s))

        return regimes_between(found, h, start, high, grading.breaks, piece)

    def beginnings(self, grading: Grading, h: Array) -> list[tuple[Array, Bound]]:
        """Where formulas begin or end: beyond penetrations above these heights, one for each separation.

        On unloading pieces are those of the deepest penetration, until contact is lost.
        """
        turn, count = np.broadcast_to(self.lowest(h), h.shape), len(self.law.limits(np.ones(self.law.radii)))
        found = [(turn, limit_of(self.law, grading, j)) for j in range(count)]

        def lost(s: Array, which: Ints) -> Array:
            s, which = np.broadcast_arrays(s, which)
            return self.of_some(which).residual(s, grading(s))

        return found if self.deepest is None else [*found, (h, lost)]

    def root_at_touch(self, piece: int) -> bool:
        """Whether formulas of a piece that begins from nothing take negative roots as well."""
        return self.law.root if piece == 0 else self.deepest is not None and self.law.unloading().root

    def residual(self, s: Array, e: Array) -> Array:
        """Penetration at which asperities are lost on unloading; infinite of those never in contact."""
        assert self.deepest is not None
        deepest = s - self.deepest
        left = self.law.unloading().residual(np.maximum(deepest, 0.0), e)
        return np.where(deepest >= 0, left, np.inf)

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """Penetration left until contact is lost, whose root the formulas take."""
        return above if self.deepest is None else above - self.residual(h + above, e)

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """Which formula holds at heights `above` the separations, -1 without contact."""
        above, h, e = np.broadcast_arrays(above, h, e)
        piece = piece_of(self.law, self._penetration(h, above), e)
        lost = 0.0 if self.deepest is None else self.residual(h + above, e)
        return np.where(above > lost, piece, -1)

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0
    ) -> Array:
        """Return what contacts of a piece add at heights `above` the separations, over the scale.

        With a `sign` of -1 the formula goes on to negative roots of the penetration.
        """
        if self.deepest is None:
            return self.of_root(quantity, piece, sign * np.sqrt(above), e)
        deepest = self._penetration(h, above)
        unloading = self.law.unloading()
        y = sign * np.sqrt(np.maximum(above - unloading.residual(deepest, e), 0.0))
        return self.added(quantity, unloading, piece, y, deepest, e)

    def of_root(self, quantity: str, piece: int, y: Any, e: Array) -> Array:
        """Return the same, closer than ever before, of the root of the penetration, which may be complex."""
        return self.added(quantity, self.law, piece, y, e)

    def added(self, quantity: str, formulas: ContactLaw | Unloading, piece: int, *at: Any) -> Array:
        """Return a quantity by formulas at what they take, and by what spots conduct through."""
        if quantity != "conductance_si":
            return of_spot(quantity, formulas, piece, *at)
        if self.conductance is None:
            raise ValueError("conductance_si: give a resistivity")
        return self.conductance(of_spot("conductance", formulas, piece, *at))

    def _penetration(self, h: Array, above: Array) -> Array:
        """Deepest one."""
        return above if self.deepest is None else above + (h - self.deepest)


def term_of(quantity: str, branch: Branch, h: ArrayLike, heights: ArrayLike, e: ArrayLike) -> Array:
    """Return what asperities add at a separation, 0 without contact: literally, each by its own formula.

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
    return np.asarray(terms_of([quantity], branch, h, heights, e)[0])


def terms_of(
    quantities: Sequence[str], branch: Branch, h: ArrayLike, heights: ArrayLike, e: ArrayLike
) -> Array:
    """Several quantities of one branch, as `term_of`: shape (quantities, *common shape).

    A law made for summits of different radii is that of the last axis.
    """
    h, s, e = (np.asarray(x, dtype=np.float64) for x in (h, heights, e))
    pieces = branch.pieces(h, s - h, e)
    x, above, modulus = (np.broadcast_to(each, pieces.shape) for each in (h, s - h, e))
    result = np.zeros((len(quantities), *pieces.shape))
    for piece in range(int(pieces.max(initial=-1)) + 1):
        here = pieces == piece
        if not here.any():
            continue
        of_piece, at = branch.of_some(here), (x[here], above[here], modulus[here])
        for k, quantity in enumerate(quantities):
            result[k, here] = of_piece.value(quantity, piece, *at)
    return result


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
class Ways:
    """Contact history: the law of contact, where unloading began, and what the spots conduct through.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    unload_from : float, optional
        Lowest separation reached before unloading, d/sigma.
    conductance : SpotConductance, optional
        Of "conductance_si".
    """

    law: ContactLaw
    unload_from: float | None = None
    conductance: SpotConductance | None = None

    def with_radii(self, ratios: Array) -> "Ways":
        """Those of summits whose radii are these multiples of the surface's, each in its own units."""
        own = self.loading.with_radii(ratios)
        return replace(self, law=own.law, conductance=own.conductance)

    def term(self, quantity: str, h: float | Array, s: Array, e: Array, ratios: Array | None = None) -> Array:
        """Return what summits, perhaps of radii of their own, add at a separation, 0 without contact.

        Parameters
        ----------
        quantity : str
            Its name, on whatever way.
        h : float or ndarray
            Reduced separation.
        s, e, ratios : ndarray
            Reduced heights, moduli E*(s)/E*, and radii over that of the surface, shape (summits,); None: all
            have that of the surface.

        Returns
        -------
        ndarray
            Over the quantity's scale for the radius of the surface, shape (summits,).
        """
        q = quantity_of(quantity)
        if ratios is None:
            return term_of(q.base, self.of(quantity), h, s, e)
        return np.asarray(ratios**q.radius * term_of(q.base, self.with_radii(ratios).of(quantity), h, s, e))

    def of(self, quantity: str) -> Branch:
        """Return the branch that a quantity is on.

        Where nothing yields, unloading follows the loading curve, from any separation.

        Raises
        ------
        KeyError
            If there is no such quantity.
        ValueError
            If unloading, or what spots conduct through, is not known.
        """
        q = quantity_of(quantity)
        if q.base == "conductance_si" and self.conductance is None:
            raise ValueError(f"quantity = {quantity!r}: give a film, or at least a resistivity")
        if not q.unloading or self.law.elastic:
            return self.loading
        self.law.unloading()  # a law that has none says so
        if self.unload_from is None:
            raise ValueError(
                f"quantity = {quantity!r}: asperities yield under law = {self.law.name!r}; give unload_from, "
                "the lowest separation reached before"
            )
        return Branch(self.law, self.conductance, self.unload_from)

    @property
    def loading(self) -> Branch:
        """The loading branch."""
        return Branch(self.law, self.conductance)

    def among(self, quantities: Iterable[str]) -> tuple[Branch, ...]:
        """Return the branches of some quantities, each once."""
        return tuple(dict.fromkeys(self.of(name) for name in quantities))
