"""The exact law of a finite surface: of a sum over its asperities, and of the separation, without a draw."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from analytic.arrays import Array
from analytic.curvature import MEAN_CURVATURE
from analytic.distribution import Counted, Law, OneAsperity, shares, shares_at
from analytic.height_rule import HeightRule
from analytic.mean_model import LOWEST
from analytic.measured_summits import MeasuredHeights
from analytic.quantities import quantity_of

_POINTS = 2**15, 5 * 2**13  # of a lattice, and of another one
_CELLS = 12_288, 20_480  # of the heights, by the root of the probability, and as many evenly between nodes
SCORES, _HIGHEST, _APART = 6.0, 6.5, 0.4  # of normal scores: looked for, told, and from one to the next
_LONGER, _SMALLEST, _TABLE = 1.25, 1e-3, 8192
_LEVEL = 1e-9  # of a score: all asperities touch, and the rest of the surfaces have none
_JUST = 1e-9  # of a cell
_DEGREE = 5  # of a spline through scores


def distribution_of(model: Any, quantity: str, h: float, *, other: bool = False) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities are independent."""
    q = quantity_of(quantity)
    if q.counts:
        from scipy.stats import binom, poisson  # takes long to import

        mean, n = float(model.mean(quantity, h)), model.number
        return Counted(poisson(mean) if model.count == "poisson" else binom(round(n), mean / n))
    one, unit = one_asperity(model, quantity, h, _CELLS[other]), q.scale(model.surface)
    x, upto = shares(one, _POINTS[other])
    lowest = -np.inf if one.low.min(initial=0) < 0 else 0.0
    again = partial(distribution_of, model, quantity, h, other=True)
    known = model.cumulants(quantity, h)
    return Law(unit * x, upto, (lowest, np.inf), again, (float(known.mean), float(known.variance)))


def one_asperity(model: Any, quantity: str, h: float, cells: int) -> OneAsperity:
    """Return what one asperity adds, over the scale of the quantity, by cells of heights."""
    lowest = min(h, model.ways.of(quantity).lowest(h))
    rule = model.rule([h], [quantity])
    at_nodes = rule.terms([quantity], [h], model.grading, model.ways)
    low, high, p = in_cells(model, [quantity], h, rule, at_nodes, cells, lowest)
    low, high = low[:, 0], high[:, 0]
    touching = ((low != 0) | (high != 0)) & (p > 0)
    low, high, p = (x[touching] for x in (np.minimum(low, high), np.maximum(low, high), p))
    order = np.argsort(low + high)
    return OneAsperity(low[order], high[order], p[order], model.number, model.count == "poisson")


def in_cells(
    model: Any, several: Sequence[str], h: float, rule: HeightRule, at_nodes: Array, cells: int, lowest: float
) -> tuple[Array, Array, Array]:
    """Return what asperities add at both ends of cells between the nodes of a rule, and probabilities.

    Over scales, shape (cells, quantities). Listed heights are cells of no width; others keep the means.
    """
    p = rule.probabilities
    if not p.any() or isinstance(model.heights, MeasuredHeights):
        return at_nodes, at_nodes, p
    left, wide, own, ratios = _cells_between(model, rule, cells, max(lowest, model.heights.support[0]))
    at = np.concatenate([left + _JUST * wide, left + wide])  # right of where contacts begin
    nodes = HeightRule(at, 0 * at, rule.below, None if ratios is None else np.tile(ratios, 2))
    low, high = np.split(nodes.terms(several, [h], model.grading, model.ways), 2)
    missing, size = 2 * p @ at_nodes - own @ (low + high), own @ (np.abs(low) + np.abs(high))
    share = missing / np.where(size > 0, size, 1.0)
    return low + share * np.abs(low), high + share * np.abs(high), own


def _cells_between(
    model: Any, rule: Any, cells: int, lowest: float
) -> tuple[Array, Array, Array, Array | None]:
    """Return the lower ends of cells between the nodes of a rule, widths, probabilities, and ratios of radii.

    They are finer where more asperities are; the first begins at the lowest height.
    """
    s, p, ratios = rule.heights, rule.probabilities, rule.ratios
    if ratios is not None:  # radius by radius
        order = np.lexsort((s, -ratios))
        s, p, ratios = s[order], p[order], ratios[order]
    root = np.sqrt(p)
    parts = np.ceil(cells * (root / root.sum() + 1 / root.size)).astype(np.int64)
    new = np.arange(s.size) == 0 if ratios is None else np.diff(ratios, prepend=np.inf) != 0
    start = np.where(new, lowest, np.append(lowest, s[:-1]))
    wide = np.repeat((s - start) / parts, parts)
    number = np.arange(wide.size) - np.repeat(np.cumsum(parts) - parts, parts)
    left = np.repeat(start, parts) + number * wide
    middle, which = left + wide / 2, np.cumsum(new) - 1
    if ratios is None:
        own = wide * model.heights.pdf(middle)
    else:
        ratios = np.repeat(ratios, parts)
        own = wide * model.curvature.density(middle, MEAN_CURVATURE / ratios)
    whole, which = np.bincount(which, p), np.repeat(which, parts)  # each radius keeps its share
    return left, wide, own * (whole / np.bincount(which, own))[which], ratios


def separation_law_of(model: Any, load: float, quantity: str, *, other: bool = False) -> Law:
    """As `analytic.Model.separation_law`, of a model whose asperities are independent."""
    from scipy.interpolate import make_interp_spline  # takes long to import

    q = quantity_of(quantity)
    if q.counts or q.unloading:
        raise ValueError(
            f"quantity = {quantity!r}: give a sum that decreases with the separation, such as 'load'"
        )
    score, start, spread = scores_of(model, quantity, load, other=other)
    h = between(score, start + other * spread / 7, spread, _APART)
    z = np.array([score(at) for at in h])
    x = np.interp(np.linspace(0, len(h) - 1, _TABLE), np.arange(len(h)), h)
    smooth = np.maximum.accumulate(make_interp_spline(h, z, min(_DEGREE, len(h) - 1))(x))
    x, upto = x[np.abs(smooth) < SCORES], ndtr(smooth[np.abs(smooth) < SCORES])
    again = partial(separation_law_of, model, load, quantity, other=True)
    return Law(x, upto, (-np.inf, np.inf), again)


def scores_of(
    model: Any, quantity: str, value: float, *, other: bool = False
) -> tuple[Callable[[float], float], float, float]:
    """Return the normal score, at a separation, of the share of surfaces whose sum is no more than a value.

    And where the mean surface has that value, and how far others lie from there, to first order. Sums that
    may rise with the separation are a ValueError.
    """
    start = float(model.separation_at(quantity, value))
    rule = model.rule([start], [quantity])
    fall = model.ways.loading.falls(quantity_of(quantity).base, model.grading(rule.heights))
    if fall == 0 or np.any(rule.terms([quantity], [start], model.grading, model.ways) < 0):
        raise ValueError(
            f"quantity = {quantity!r}: it is negative for some asperities, and sums may increase with the "
            "separation; use a modulus >= 0 and a law without adhesion"
        )
    if fall:
        raise ValueError(
            f"quantity = {quantity!r}: it decreases where the law changes to its piece {fall}, and sums "
            f"may increase with the separation; use the load"
        )

    @cache
    def score(h: float) -> float:
        share = shares_upto(model, quantity, h, model.number, np.array([value]), other=other)
        return float(np.clip(ndtri(np.clip(share[0], 0.0, 1.0)), -_HIGHEST, _HIGHEST))

    return score, start, float(model.std(quantity, start) / model.slope(quantity, start))


def between(
    score: Callable[[float], float], start: float, spread: float, apart: float = math.inf
) -> list[float]:
    """Return separations from one that next to no surface is below to one that next to none is above.

    Their scores are at most so far apart.
    """
    places, step, moved = [start], spread / 3, 1.0
    while score(places[-1]) < SCORES:  # far, where tails are heavy
        places.append(places[-1] + step * _LONGER ** len(places))
    while score(places[0]) > -SCORES and moved > _LEVEL and places[0] > LOWEST:
        places.insert(0, max(places[0] - step, LOWEST))
        moved = score(places[1]) - score(places[0])
    k = 1
    while k < len(places):
        left, right = places[k - 1], places[k]
        if score(right) - score(left) > apart and right - left > _SMALLEST * spread:
            places.insert(k, (left + right) / 2)
        else:
            k += 1
    return places


def shares_upto(
    model: Any, quantity: str, h: float, number: float, values: Array, *, other: bool = False
) -> Array:
    """Return the shares of surfaces of a number of asperities whose sum is no more than some values, SI.

    They are right to 1e-6 or better. For what is integrated over: one lattice that suits the largest of
    them, without the far tails of a `Law`.
    """
    if number < 1:
        return np.where(values >= 0, 1.0, 0.0)
    one = replace(one_asperity(model, quantity, h, _CELLS[other] // 4), number=number)
    return shares_at(one, values / quantity_of(quantity).scale(model.surface), _POINTS[other] // 8)
