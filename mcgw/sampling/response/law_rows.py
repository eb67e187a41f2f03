"""Rows of any other law of contact: for each quantity and separation as many as pieces hold there."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Homogeneous, quantity_of
from analytic.arrays import Array, Ints
from analytic.laws import Branch
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.rows import Rows, sixteen, sure_sums
from mcgw.sampling.stretches import Stretches, stretches_of
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class _Pieces:
    """Formulas of pieces of a law."""

    kinds: tuple[tuple[Branch, str, int, float], ...]  # branch, quantity, piece and scale of each kind of row
    kind: Ints  # of each row
    h: Array  # separation of each row
    low: Array  # height from which on it holds

    def values(self, rows: Ints, above: Array, e: Array) -> Array:
        """Values at heights `above` the separation of each row, of modulus `e`: shape (rows, points)."""
        return self._values(rows, above, e, 1.0)

    def at_start(self, rows: Ints, above: Array, e: Array, u: Array) -> list[tuple[bool, Ints, Array, Array]]:
        """Return the same where each row begins, on the cell or node of variable u, `above` its start.

        Smooth functions of u: whether they are still to be multiplied by sqrt(u), of which of the rows they
        are, their values, and the whole powers of u that they are to be multiplied by besides. The even part
        in the root of the penetration is smooth, the odd part has the root as a factor.
        """
        above = (self.low[rows] - self.h[rows])[:, None] + above
        forth, back = (self._values(rows, above, e, sign) for sign in (1.0, -1.0))
        every, none = np.arange(len(rows)), np.zeros(len(rows))
        even, odd = (forth + back) / 2, (forth - back) / 2 / np.sqrt(u)
        return [(False, every, even, none), (True, every, odd, none)]

    def _values(self, rows: Ints, above: Array, e: Array, sign: float) -> Array:
        result = np.empty(above.shape)
        for here, (branch, quantity, piece, scale) in self._by_kind(rows):
            h = self.h[rows[here]]
            value = branch.value(quantity, piece, h, above[here].T, e[here].T, sign=sign)
            result[here] = scale * value.T
        return result

    def _by_kind(self, rows: Ints) -> Iterator[tuple[Ints, tuple[Branch, str, int, float]]]:
        """Which of the rows are of each kind."""
        kind = self.kind[rows]
        order = np.argsort(kind, kind="stable")
        found, start = np.unique(kind[order], return_index=True)
        if not found.size:
            return
        for number, here in zip(found.tolist(), np.split(order, start[1:]), strict=True):
            yield here, self.kinds[number]


def law_rows(scene: Scene, quantities: tuple[str, ...], mesh: Mesh) -> Rows:
    """Return rows of quantities at all separations of a scene: by quantity, separation and piece, increasing.

    None of the quantities counts asperities; cells of the mesh end at every break of the contact law.
    """
    separations = np.array(scene.all_separations)
    parts: list[tuple[NDArray[Any], ...]] = []
    stretches: dict[Branch, Stretches] = {}
    kinds: list[tuple[Branch, str, int, float]] = []
    touching, approach = sixteen(scene.heights, separations.tobytes())
    heights = approach + separations[:, None]
    contacts, e = scene.n_asperities * touching, scene.modulus(heights)
    for number, name in enumerate(quantities):
        q, branch = quantity_of(name), scene.ways.of(name)
        if branch not in stretches:
            stretches[branch] = stretches_of(scene, branch, *mesh.range)
        found = stretches[branch]
        roots = (found.piece == 0) & branch.law.root
        scale = q.scale(scene.surface)
        total = sure_sums(contacts, scale, branch.terms([q.base], separations[:, None], heights, e)[0])
        parts.append(
            (
                separations[found.separation],
                found.low,
                found.high,
                found.begins & roots,
                found.begins & roots,
                found.begins & ~roots,
                found.lost,
                len(kinds) + found.piece,
                number * len(separations) + found.separation,
                total[found.separation],
            )
        )
        kinds += [(branch, q.base, piece, scale) for piece in range(int(found.piece.max(initial=-1)) + 1)]
    h, low, high, begins, rooted, rough, lost, kind, answer, total = (
        np.concatenate(x) for x in zip(*parts, strict=True)
    )
    graded = np.full(len(h), not isinstance(scene.modulus, Homogeneous))
    formulas = _Pieces(tuple(kinds), kind, h, low)
    return Rows(h, low, high, begins, rooted, rough, lost, graded, kind, answer, total, formulas)
