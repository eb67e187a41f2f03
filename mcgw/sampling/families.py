"""The response where summits have radii of their own: one matrix for each power of the radius.

Sums of load, stiffness and conductance count a summit with the root of its radius, areas with the radius. The
matrices are those of one radius; only the moments differ (`mcgw.sampling.weighted_sums`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.sampling.layout import Layout
from mcgw.sampling.response.response import Response, matrix_of

POWERS = (0.5, 1.0)  # of the radius, that quantities have


@dataclass(frozen=True)
class Families:
    """Responses side by side.

    Parameters
    ----------
    powers : tuple of float
        Of the radius, one a family: only those that are asked for.
    responses : tuple of Response
        One a family.
    places : tuple of int
        Where each of their quantities, family by family, stands among all.
    drawn : tuple of Layout, optional
        Moments of each family, where there are more than it needs.
    """

    powers: tuple[float, ...]
    responses: tuple[Response, ...]
    places: tuple[int, ...]
    drawn: tuple[Layout, ...] = ()

    @classmethod
    def of(
        cls,
        quantities: tuple[str, ...],
        response_to: Callable[[float, tuple[str, ...]], Response],
        *,
        every: bool,
    ) -> "Families":
        """Sort quantities by their power, and have a response made for each power and its quantities.

        With `every`, there is a family also for a power that no quantity has.
        """
        power = [quantity_of(name).radius for name in quantities]
        powers = POWERS if every else tuple(sorted(set(power)))
        groups = [[i for i, p in enumerate(power) if p == one] for one in powers]
        responses = tuple(
            response_to(one, tuple(quantities[i] for i in group))
            for one, group in zip(powers, groups, strict=True)
        )
        return cls(powers, responses, tuple(i for group in groups for i in group))

    @cached_property
    def layout(self) -> Layout:
        """The moments of each cell, one family after the other."""
        parts = self._layouts
        none = [np.empty(0, dtype=np.int64)]
        return Layout(
            np.concatenate(none + [part.plain for part in parts]),
            np.concatenate(none + [part.rooted for part in parts]),
        )

    @property
    def _layouts(self) -> tuple[Layout, ...]:
        return self.drawn or tuple(response.layout for response in self.responses)

    def apart(self, layout: Layout) -> tuple[Layout, ...]:
        """The moments of each family, of those of all of them."""
        if not self.powers:
            return ()
        plain, rooted = (np.split(x, len(self.powers)) for x in (layout.plain, layout.rooted))
        return tuple(Layout(*each) for each in zip(plain, rooted, strict=True))

    def out_of(self, layout: Layout) -> "Families":
        """The same, bit by bit, out of moments of which each cell may have more than this needs."""
        drawn = self.apart(layout)
        responses = tuple(x.out_of(more) for x, more in zip(self.responses, drawn, strict=True))
        return replace(self, responses=responses, drawn=drawn)

    def layout_of(self, power: float | None) -> Layout:
        """The moments of one family."""
        return self.responses[self.powers.index(power or 0.0)].layout

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, surfaces, separations)."""
        ends = np.cumsum([layout.starts[-1] for layout in self._layouts])
        parts = np.split(moments, ends[:-1])
        found = np.concatenate(
            [response @ part for response, part in zip(self.responses, parts, strict=True)]
        )
        answers = np.empty_like(found)
        answers[list(self.places)] = found
        return answers

    def matrix(self) -> Array:
        """All of it as numbers, shape (quantities, separations, moments): large, slow and plain to see."""
        return matrix_of(self)
