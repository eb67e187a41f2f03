"""Which way a surface has gone to the separation that a quantity is about."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analytic.laws.branch import Branch, LoadingBranch, UnloadingBranch
from analytic.laws.film import SpotConductance
from analytic.laws.law import ContactLaw
from analytic.quantities import quantity_of

__all__ = ["Ways"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ways:
    """A law of contact, the history of the surface, and what its spots conduct through.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    unload_from : float, optional
        Lowest separation reached before quantities on the way back are asked for, d/sigma.
    conductance : SpotConductance, optional
        Of "conductance_si".
    """

    law: ContactLaw
    unload_from: float | None = None
    conductance: SpotConductance | None = None

    def with_radii(self, ratios: Array) -> "Ways":
        """Those of summits whose radii are these multiples of the surface's, each in its own units."""
        conductance = None if self.conductance is None else self.conductance.with_radii(ratios)
        return replace(self, law=self.law.with_radii(ratios), conductance=conductance)

    def term(self, quantity: str, h: float, s: Array, e: Array, ratios: Array) -> Array:
        """What summits of radii of their own add at a separation, 0 without contact.

        Parameters
        ----------
        quantity : str
            Its name, on whatever way.
        h : float
            Reduced separation.
        s, e, ratios : ndarray
            Reduced heights, moduli E*(s)/E*, and radii over that of the surface, shape (summits,).

        Returns
        -------
        ndarray
            Over the quantity's scale for the radius of the surface, shape (summits,).
        """
        q, above = quantity_of(quantity), s - h
        pieces, result = self.with_radii(ratios).of(quantity).pieces(np.full(s.shape, h), above, e), 0.0 * s
        for piece in np.unique(pieces[pieces >= 0]).tolist():
            here = pieces == piece
            branch = self.with_radii(ratios[here]).of(quantity)
            result[here] = branch.value(q.base, piece, np.full(here.sum(), h), above[here], e[here])
        return np.asarray(ratios**q.radius * result)

    def of(self, quantity: str) -> Branch:
        """The branch that a quantity is on.

        Where nothing yields the way back is the way there, from whatever separation.

        Raises
        ------
        KeyError
            If there is no such quantity.
        ValueError
            If the way back, or what spots conduct through, is not known.
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
        return UnloadingBranch(self.law, self.unload_from, self.conductance)

    @property
    def loading(self) -> LoadingBranch:
        """The way there."""
        return LoadingBranch(self.law, self.conductance)

    def among(self, quantities: Iterable[str]) -> tuple[Branch, ...]:
        """The branches of some quantities, each once."""
        return tuple(dict.fromkeys(self.of(name) for name in quantities))
