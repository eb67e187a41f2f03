"""History of a surface: loading, and unloading from the lowest separation that it reached.

A branch says at which heights which formula holds, and gives the formulas at heights above the separation.
So everything that sums over asperities treats loading, unloading and any law of contact alike.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)``, as yielding or
lift-off, has begun where ``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on
several intervals if it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array, Ints, hold
from analytic.gradings import Grading, Homogeneous
from analytic.laws.film import Film
from analytic.laws.law import ContactLaw, piece_of, slope_in_root
from analytic.quantities import quantity_of
from analytic.resolution import stretches
from analytic.roots import sign_changes


class Regimes(NamedTuple):
    """Intervals of heights on each of which one piece of the law holds, of each separation upwards."""

    separation: Ints  # which of the separations, not decreasing
    low: Array  # reduced heights ``low <= s < high``
    high: Array
    piece: Ints  # its number


@dataclass(frozen=True)
class Branch:
    """History of a surface: its law of contact, where unloading began, what spots conduct through."""

    law: ContactLaw  # in reduced units
    unload_from: float | None = None  # lowest separation that it has reached, d/sigma; None on loading
    film: Film | None = None  # of "conductance_si", on the surface
    ratios: Array | None = None  # of the radii of summits to that of the surface, along the last axis of all

    def of(self, quantity: str) -> Self:
        """Return the branch that a quantity is on; one that is not known here is refused."""
        q = quantity_of(quantity)
        if q.base == "conductance_si" and self.film is None:
            raise ValueError(f"quantity = {quantity!r}: give a film, or at least a resistivity")
        if not q.unloading or self.law.elastic:  # unloading follows the loading curve, from anywhere
            return self.loading
        self.law.unloading(0.0)  # a law that has none says so
        if self.unload_from is None:
            raise ValueError(
                f"quantity = {quantity!r}: asperities yield under law = {self.law.name!r}; give unload_from, "
                "the lowest separation reached before"
            )
        if not self.law.stiff and q.base in ("stiffness", "load_slope"):
            raise ValueError(
                f"quantity = {quantity!r}: the stiffness of contacts that break off has no variance (law = "
                f"{self.law.name!r}); leave stiffness and load_slope out, or unload_from"
            )
        return self

    @property
    def loading(self) -> Self:
        """The loading branch."""
        return replace(self, unload_from=None)

    def among(self, quantities: Iterable[str]) -> tuple[Self, ...]:
        """Return the branches of some quantities, each once."""
        return tuple(dict.fromkeys(self.of(name) for name in quantities))

    @cached_property
    def one_piece(self) -> bool:
        """Whether one formula holds from the separation upwards."""
        return self.unload_from is None and not self.law.limits(np.ones(1)).size

    def with_radii(self, ratios: Array | None) -> Self:
        """Return that of summits whose radii are these multiples of the surface's, each in its own units."""
        return replace(self, ratios=ratios)

    def of_some(self, which: NDArray[Any]) -> Self:
        """Return that of selected summits, by a mask, or by numbers that begin again beyond the last."""
        if self.ratios is None:
            return self
        if which.dtype == np.bool_:
            return replace(self, ratios=np.broadcast_to(self.ratios, which.shape)[which])
        return replace(self, ratios=self.ratios[which % self.ratios.size])

    def terms(
        self, quantities: Sequence[str], h: ArrayLike, s: ArrayLike, e: ArrayLike, *, slope: bool = False
    ) -> Array:
        """Return what summits of this branch add at separations, each by its own formula, 0 without contact.

        Separations, heights and moduli E*(s)/E* broadcast; over scales for the radius of the surface, shape
        (quantities, *common shape). With `slope` the derivatives by the penetration instead, within a piece.
        """
        h, s, e = (np.asarray(x, dtype=np.float64) for x in (h, s, e))
        names = [quantity_of(name).base for name in quantities]
        if self.one_piece:
            with np.errstate(invalid="ignore"):  # of moduli < 0 where nothing touches
                found = [self.value(name, 0, h, s - h, e, slope=slope) for name in names]
            result = np.where(s - h > 0, found, 0.0)
        else:
            result = self._of_pieces(names, h, s, e, slope)
        if self.ratios is not None:
            for k, quantity in enumerate(quantities):
                result[k] *= self.ratios ** quantity_of(quantity).radius
        return result

    def _of_pieces(self, names: Sequence[str], h: Array, s: Array, e: Array, slope: bool) -> Array:
        """Return `terms` where several formulas hold."""
        pieces = self.pieces(h, s - h, e)
        at = [np.broadcast_to(x, pieces.shape) for x in (h, s - h, e)]
        result = np.zeros((len(names), *pieces.shape))
        for piece in range(int(pieces.max(initial=-1)) + 1):
            here = pieces == piece
            if here.any():
                some, there = self.of_some(here), [x[here] for x in at]
                for k, name in enumerate(names):
                    result[k, here] = some.value(name, piece, *there, slope=slope)
        return result

    def value(
        self, quantity: str, piece: int, h: Array, above: Array, e: Array, *, sign: float = 1.0,
        slope: bool = False,
    ) -> Array:  # fmt: skip
        """Return what contacts of a piece add at heights above the separations, over scales of own radii."""
        law = self._law(self.deepest(h, above))
        y = sign * np.sqrt(np.maximum(law.left(above, e), 0.0))  # formulas go on to negative roots
        shape = np.broadcast_shapes(np.shape(y), np.shape(e))
        known: dict[str, Callable[[Any], Any]] = {
            "load": lambda y: law.load(piece, y, e),
            "area": lambda y: law.radius(piece, y, e) ** 2,
            "stiffness": lambda y: law.stiffness(piece, y, e),
            "contacts": lambda y: np.ones(shape),  # noqa: ARG005 - whatever the penetration
            "conductance": lambda y: law.radius(piece, y, e),
            "conductance_si": lambda y: self.film.conductance(law.radius(piece, y, e), self.ratios),  # type: ignore[union-attr]
            "load_slope": lambda y: slope_in_root(lambda v: law.load(piece, v, e), y) * (2 / 3),
            "yielded": lambda y: np.full(shape, float(piece > 0)),  # noqa: ARG005
        }
        return np.asarray(slope_in_root(known[quantity], y) if slope else known[quantity](y))

    def falls(self, quantity: str, e: Array) -> int | None:
        """Return the first piece at whose start contacts add less than before, or than nothing; or None."""
        e = np.maximum(e, np.finfo(float).tiny)
        for piece, limit in enumerate([np.zeros_like(e), *self.limits(e)]):
            with np.errstate(all="ignore"):  # without a modulus nothing yields, at no limit
                after, before = (self.value(quantity, j, 0 * e, limit, e) for j in (piece, max(piece - 1, 0)))
            if np.any(after < (before * (1 - 1e-9) if piece else 0.0)):
                return piece
        return None

    def _law(self, deepest: Array | None = None) -> ContactLaw:
        """Law of contacts that are closer than ever before, or on unloading have been this deep."""
        law = self.law
        if self.ratios is not None:  # each in units of its own radius
            law, of_radius = copy(law), law.of_radius.items()
            hold(law, **{name: getattr(law, name) * self.ratios**power for name, power in of_radius})
        return law if self.unload_from is None or deepest is None else law.unloading(np.maximum(deepest, 0.0))

    def lowest(self, h: Any) -> Any:
        """Height below which nothing touches, at a separation or at higher ones, in its shape."""
        return h if self.unload_from is None else self.unload_from

    def deepest(self, h: Array, above: Array) -> Array:
        """Deepest penetration."""
        return above if self.unload_from is None else np.asarray(above + (h - self.unload_from))

    def limits(self, e: Array) -> Array:
        """Penetrations at which the next piece begins, increasing; shape (pieces - 1, *common shape)."""
        return self._law().limits(e)

    def left(self, h: Array, above: Array, e: Array) -> Array:
        """Penetration left until contact is lost, whose root the formulas take; -inf without any before."""
        deepest = self.deepest(h, above)
        return np.where(deepest >= 0, self._law(deepest).left(above, e), -np.inf)

    def pieces(self, h: Array, above: Array, e: Array) -> Ints:
        """Which formula holds at heights `above` the separations, -1 without contact."""
        return np.where(self.left(h, above, e) > 0, piece_of(self._law(), self.deepest(h, above), e), -1)

    def regimes(self, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
        """Return at which heights of a range there is contact, and which formula holds there.

        Where summits have radii of their own, separations have these in turn. Under one modulus for all, what
        a bound asks must rise with the height.
        """
        h = np.asarray(separations, dtype=np.float64)
        every, start = np.arange(h.size), np.maximum(np.broadcast_to(self.lowest(h), h.shape), low)
        which, edge = self._crossings(grading, h, low, high)
        which = np.concatenate([every, every, which])
        edge = np.concatenate([start, np.full(h.size, high), edge])
        anchors = np.unique([*start, *h, *grading.breaks, high])  # ends next to one of them are the same
        nearest = anchors[np.searchsorted((anchors[1:] + anchors[:-1]) / 2, edge)]
        same = 8 * np.spacing(np.maximum(np.abs(edge), np.abs(h[which])))  # found from ``s - h``
        edge = np.maximum(np.where(np.abs(nearest - edge) <= same, nearest, edge), start[which])
        order = np.lexsort((edge, which))
        which, edge, same = which[order], edge[order], same[order]
        apart = np.append(True, (np.diff(which) > 0) | (np.diff(edge) > same[1:]))
        which, edge = which[apart], edge[apart]
        inside = np.flatnonzero(which[1:] == which[:-1])
        which, begin, end = which[inside], edge[inside], edge[inside + 1]
        middle = begin + (end - begin) / 2
        piece = self.of_some(which).pieces(h[which], middle - h[which], grading(middle))
        first = np.append(True, (np.diff(which) > 0) | (np.diff(piece) != 0))[: which.size]
        last, contact = np.roll(first, -1), piece[first] >= 0
        found = which[first], begin[first], end[last], piece[first]
        return Regimes(*(each[contact] for each in found))

    def _crossings(self, grading: Grading, h: Array, low: float, high: float) -> tuple[Ints, Array]:
        """Return heights at which a bound is crossed, after the numbers of their separations."""

        def beyond(s: Array, which: Ints) -> Array:
            """How far heights are beyond each bound, at separations by their numbers: shape (bounds, ...)."""
            some, x = self.of_some(which), h[which]
            with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
                e, deepest = grading(s), some.deepest(x, s - x)
                found = [deepest - limit for limit in some.limits(e)]
                if self.unload_from is not None:
                    found.append(some.left(x, s - x, e))
                return np.reshape(found, (len(found), *deepest.shape))

        s = np.array([low, high])
        if not isinstance(grading, Homogeneous):
            s = stretches(beyond, grading, low, high, 1 if self.ratios is None else self.ratios.size)
        held = beyond(s, np.arange(h.size)[:, None]) >= 0
        bound, which, i = np.nonzero(held[..., 1:] != held[..., :-1])

        def excess(x: Array, n: Ints) -> Array:
            return np.asarray(beyond(x, which[n])[bound[n], np.arange(n.size)])

        return which, sign_changes(excess, s[i], s[i + 1], np.abs(h[which]))
