"""History of a surface: loading, and unloading from the lowest separation that it reached.

A branch says at which heights which formula holds, and gives the formulas at heights above the separation.
So everything that sums over asperities treats loading, unloading and any law of contact alike.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading
from analytic.laws.film import SpotConductance
from analytic.laws.law import ContactLaw, piece_of
from analytic.laws.regimes import Bound, Regimes, crossings, regimes_between
from analytic.laws.unloading import Unloading, slope_in_root
from analytic.quantities import quantity_of


@dataclass(frozen=True)
class Branch:
    """History of a surface: its law of contact, where unloading began, what spots conduct through.

    Without `unload_from` it is the loading branch; `of` gives the branch that a quantity is on.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    unload_from : float, optional
        Lowest separation that an unloaded surface has reached, d/sigma.
    conductance : SpotConductance, optional
        Of "conductance_si".
    """

    law: ContactLaw
    unload_from: float | None = None
    conductance: SpotConductance | None = None

    def of(self, quantity: str) -> Self:
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
        return self

    @property
    def loading(self) -> Self:
        """The loading branch."""
        return self if self.unload_from is None else replace(self, unload_from=None)

    def among(self, quantities: Iterable[str]) -> tuple[Self, ...]:
        """Return the branches of some quantities, each once."""
        return tuple(dict.fromkeys(self.of(name) for name in quantities))

    def with_radii(self, ratios: Array) -> Self:
        """Return that of summits whose radii are these multiples of the surface's, each in its own units."""
        own = self.conductance and self.conductance.with_radii(ratios)
        return replace(self, law=self.law.with_radii(ratios), conductance=own)

    def of_some(self, which: NDArray[Any]) -> Self:
        """Return the law of selected summits; itself where all have one radius."""
        own = self.conductance and self.conductance.of_some(which)
        return replace(self, law=self.law.of_some(which), conductance=own)

    @property
    def finest(self) -> float:
        """How far above first touch formulas are analytic."""
        return min(self.law.finest, self.conductance.finest) if self.conductance else self.law.finest

    def root_at_touch(self, piece: int) -> bool:
        """Whether formulas of a piece that begins from nothing take negative roots as well."""
        return self.law.root if piece == 0 else self.unload_from is not None and self._formulas.root

    # --- what asperities add ---

    def term(self, quantity: str, h: ArrayLike, s: Array, e: Array, ratios: Array | None = None) -> Array:
        """Return what summits, perhaps of radii of their own, add at a separation, 0 without contact.

        Literally, each by its own formula.

        Parameters
        ----------
        quantity : str
            Its name, on whatever way.
        h : array_like
            Reduced separations.
        s, e, ratios : ndarray
            Reduced heights, moduli E*(s)/E*, and radii over that of the surface, whose shapes broadcast;
            None: all have that of the surface.

        Returns
        -------
        ndarray
            Over the quantity's scale for the radius of the surface, in their common shape.
        """
        q, branch = quantity_of(quantity), self.of(quantity)
        if ratios is None:
            return np.asarray(branch.terms([q.base], h, s, e)[0])
        return np.asarray(ratios**q.radius * branch.with_radii(ratios).terms([q.base], h, s, e)[0])

    def terms(self, quantities: Sequence[str], h: ArrayLike, heights: ArrayLike, e: ArrayLike) -> Array:
        """Several quantities on this branch: shape (quantities, *common shape).

        A law made for summits of different radii is that of the last axis.
        """
        h, s, e = (np.asarray(x, dtype=np.float64) for x in (h, heights, e))
        pieces = self.pieces(h, s - h, e)
        result = np.zeros((len(quantities), *pieces.shape))
        for piece, here, branch, at in self._by_piece(pieces, h, s - h, e):
            for k, quantity in enumerate(quantities):
                result[k, here] = branch.value(quantity, piece, *at)
        return result

    def slopes(self, quantity: str, penetration: Array, e: Array) -> Array:
        """Return derivatives by the penetration of what asperities add on loading, within a piece.

        Of reduced penetrations s - h, 0 where they are negative, and moduli E*(s)/E*, in their common shape.
        """
        pieces = np.where(penetration > 0, piece_of(self.law, penetration, e), -1)
        result = np.zeros(pieces.shape)
        for piece, here, branch, (depth, modulus) in self._by_piece(pieces, penetration, e):
            of_root = partial(branch.of_root, quantity, piece, e=modulus)
            result[here] = slope_in_root(of_root, np.sqrt(depth))
        return result

    def _by_piece(self, pieces: Ints, *at: Array) -> Iterator[tuple[int, Marks, Self, list[Array]]]:
        """Pieces that occur, where they do, the branch of the summits there, and other values there."""
        at = tuple(np.broadcast_to(x, pieces.shape) for x in at)
        for piece in range(int(pieces.max(initial=-1)) + 1):
            here = pieces == piece
            if here.any():
                yield piece, here, self.of_some(here), [x[here] for x in at]

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0
    ) -> Array:
        """Return what contacts of a piece add at heights `above` the separations, over the scale.

        With a `sign` of -1 the formula goes on to negative roots of the penetration.
        """
        deepest, formulas = self._deepest(h, above), self._formulas
        y = sign * np.sqrt(np.maximum(above - formulas.residual(deepest, e), 0.0))
        return self._added(quantity, formulas, piece, y, deepest, e)

    def of_root(self, quantity: str, piece: int, y: Any, e: Array) -> Array:
        """Return the same, closer than ever before, of the root of the penetration, which may be complex."""
        return self._added(quantity, Unloading(self.law), piece, y, y * y, e)

    def _added(self, quantity: str, formulas: Unloading, piece: int, *at: Any) -> Array:
        """Return a quantity by formulas at what they take, and by what spots conduct through."""
        if quantity != "conductance_si":
            return formulas.added(quantity, piece, *at)
        if self.conductance is None:
            raise ValueError("conductance_si: give a resistivity")
        return self.conductance(formulas.radius(piece, *at))

    @property
    def _formulas(self) -> Unloading:
        """Those of contacts that are closer than ever before too, or of those that are left."""
        return Unloading(self.law) if self.unload_from is None else self.law.unloading()

    # --- where they touch ---

    def lowest(self, h: Any) -> Any:
        """Height below which nothing touches, at a separation or at higher ones, in its shape."""
        return h if self.unload_from is None else self.unload_from

    def _deepest(self, h: Array, above: Array) -> Array:
        """Deepest penetration."""
        return above if self.unload_from is None else above + (h - self.unload_from)

    def _residual(self, h: Array, above: Any, e: Array) -> Array:
        """Penetration at which asperities are lost, infinite of those never in contact."""
        if self.unload_from is None:
            return np.zeros(())
        deepest = h + above - self.unload_from
        return np.where(deepest >= 0, self._formulas.residual(np.maximum(deepest, 0.0), e), np.inf)

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """Penetration left until contact is lost, whose root the formulas take."""
        return above - self._residual(h, above, e)

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """Which formula holds at heights `above` the separations, -1 without contact."""
        above, h, e = np.broadcast_arrays(above, h, e)
        piece = piece_of(self.law, self._deepest(h, above), e)
        return np.where(above > self._residual(h, above, e), piece, -1)

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """At which heights there is contact, and which formula holds there.

        Under a law of several radii (`ContactLaw.with_radii`) separations have these in turn.
        """
        h = np.asarray(separations, dtype=np.float64)
        turn = np.broadcast_to(self.lowest(h), h.shape)
        count = len(self.law.limits(np.ones(self.law.radii)))
        bounds = [(turn, self._limit(grading, j)) for j in range(count)]
        if self.unload_from is not None:  # pieces are those of the deepest penetration, until contact is lost
            bounds.append((h, lambda s, which: self.of_some(which)._residual(s, 0.0, grading(s))))
        crossed = [crossings(bound, grading, at, low, high, self.law.radii) for at, bound in bounds]

        def piece(s: Array, which: Ints) -> Ints:
            return self.of_some(which).pieces(h[which], s - h[which], grading(s))

        return regimes_between(crossed, h, np.maximum(turn, low), high, grading.breaks, piece)

    def _limit(self, grading: Grading, j: int) -> Bound:
        """Penetration at which piece j + 1 begins, of the height and of which separation."""
        return lambda s, which: np.asarray(self.law.of_some(which).limits(grading(s))[j])
