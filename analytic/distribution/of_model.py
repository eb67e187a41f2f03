"""The laws of the quantities of a model."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from analytic.arrays import Array, Ints
from analytic.distribution.distribution import Counted, Law, Table
from analytic.distribution.sums import OneAsperity, resolved, shares, shares_at
from analytic.inversion import LOWEST
from analytic.measured_summits import MeasuredHeights
from analytic.quantities import quantity_of
from analytic.summits import Radii

_POINTS = 2**14, 5 * 2**12  # of a lattice, and of another one
_CELLS = 6144, 10_240  # of the heights, at least
_WIDE = 15  # medians of the values, or values, in which are as many cells
_MOST = 64  # a share of the cells in one gap of the rule
_SCORES, _APART, _NONE, _SMALLEST, _TABLE = 6.0, 0.4, 1e-14, 1e-3, 8192
_LEVEL = 1e-9
_GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)  # two points of a cell
_NEVER = 1e-14  # asperities on a surface
_NEIGHBOURS = 6
_ROUNDING = 1e-9  # of a law that goes on smoothly


def distribution_of(model: Any, quantity: str, h: float, *, other: bool = False) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities are independent."""
    q, poisson = quantity_of(quantity), model.count == "poisson"
    if q.counts:
        return Counted(float(model.mean(quantity, h) / model.number), model.number, poisson)
    one, unit = one_asperity(model, quantity, h, _CELLS[other]), q.scale(model.surface)
    x, below, above = shares(one, _POINTS[other])
    moments, (low, high) = (unit * one.mean, unit**2 * one.variance), one.ends
    again = partial(distribution_of, model, quantity, h, other=True)
    return Table(unit * x, below, above, moments, (unit * low, unit * high), one.rounding, again)


def one_asperity(model: Any, quantity: str, h: float, cells: int, top: float = np.inf) -> OneAsperity:
    """Return what one asperity adds, over the scale of the quantity: by cells of the heights of each radius.

    Cells in which asperities add more than `top` are wide.
    """
    rule, added = model.asperities(quantity, h)
    if rule.ratios is not None:  # radius by radius
        order = np.lexsort((rule.heights, -rule.ratios))
        s, p, ratios = (each[order] for each in (rule.heights, rule.probabilities, rule.ratios))
        rule = replace(rule, heights=s, probabilities=p, ratios=ratios)
    values, p, n = added(rule), rule.probabilities, model.number
    poisson, listed = model.count == "poisson", isinstance(model.heights, MeasuredHeights)
    mean = float(p @ values)
    square = float(p @ values**2) - (0 if poisson else mean**2)
    bounded = listed or (model.curvature is None and bool(np.isfinite(model.heights.support[1])))
    x, p = _touching(values, p)
    one = OneAsperity(x, p, x, np.cumsum(p), n * mean, n * square, n, poisson, listed, bounded)
    if listed or not x.size:
        return one
    values, p, radius = _cells(model, h, rule, added, cells, one, top, model.ways.of(quantity).lowest(h))
    x, p_of_x = _touching(values.ravel(), p.ravel())
    one = replace(one, values=x, probabilities=p_of_x, places=x, upto=np.cumsum(p_of_x))
    if not one.few:
        return one
    places = x[:: -(-x.size // (3 * cells))]
    upto = _distribution(places, values, p, radius)
    between, share = (places[1:] + places[:-1]) / 2, np.diff(upto)
    off = mean - float(share @ between + upto[0] * places[0])  # the rule has more digits
    return replace(one, places=places + off * np.abs(places) / float(share @ np.abs(between)), upto=upto)


def _touching(values: Array, p: Array) -> tuple[Array, Array]:
    """Of asperities that add something, in the order of what they add."""
    order = np.argsort(values)
    order = order[(values[order] != 0) & (p[order] > 0)]
    return values[order], p[order]


def _cells(
    model: Any, h: float, rule: Any, added: Any, cells: int, one: OneAsperity, top: float, lowest: float
) -> tuple[Array, Array, Ints]:
    """Values at two points of each of the cells of the heights, its probability by half, and its radius."""
    values, p, s = added(rule), rule.probabilities, rule.heights
    new = np.diff(rule.ratios, prepend=np.inf) != 0 if rule.ratios is not None else np.arange(s.size) == 0
    left = np.where(new, max(min(h, lowest), model.heights.support[0]), np.append(h, s[:-1]))
    gaps = np.where(new, 0.0, np.abs(np.diff(values, prepend=values[0])))
    gaps[(model.number * np.cumsum(p[::-1])[::-1] < _NEVER) | (values > top)] = 0.0
    parts = np.maximum(
        gaps * cells / (_WIDE * np.cbrt(new.sum())) / np.maximum(one.median, np.abs(values)),
        cells * p / p.sum(),
    )
    parts = np.clip(np.ceil(parts), -(-cells // p.size), cells // _MOST).astype(np.int64)
    part = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    wide = np.repeat((s - left) / parts, parts)
    left = np.repeat(left, parts) + part * wide
    s = left + wide * _GAUSS[:, None]
    if rule.ratios is None:
        ratios, density = None, model.heights.pdf(s)
    else:
        ratios, radii = np.tile(np.repeat(rule.ratios, parts), 2), Radii.over(model.curvature, h)
        density = radii.density(s.ravel(), np.searchsorted(-radii.ratios, -ratios)).reshape(s.shape)
    p = density * wide * (rule.probabilities.sum() / (density @ wide).sum())
    of_cells = replace(rule, heights=s.ravel(), probabilities=p.ravel(), ratios=ratios)
    return added(of_cells).reshape(s.shape), p, np.repeat(np.cumsum(new), parts)


def _distribution(places: Array, values: Array, p: Array, radius: Ints) -> Array:
    """Share of asperities that touch and add no more: by stretches on which values rise, or fall."""
    rising = np.sign(np.diff(values, axis=0)[0])
    rising = rising[np.maximum.accumulate(np.where(rising != 0, np.arange(rising.size), 0))]
    parts = np.append(0, np.cumsum((np.diff(rising) != 0) | (np.diff(radius) != 0)))
    touching = values.T.ravel() != 0
    values, p, parts = values.T.ravel()[touching], p.T.ravel()[touching], np.repeat(parts, 2)[touching]
    own = np.tile([1 - 2 * _GAUSS[0], 2 * _GAUSS[0]], rising.size)[touching]
    upto = np.zeros(places.size)
    for stretch in np.split(np.arange(parts.size), 1 + np.flatnonzero(np.diff(parts))):
        x, share, sum_up = values[stretch], p[stretch], np.cumsum(p[stretch])
        upto_x = sum_up - own[stretch] * share
        if x[0] > x[-1]:
            x, upto_x = x[::-1], sum_up[-1] - upto_x[::-1]
        upto += np.interp(places, np.maximum.accumulate(x), upto_x, left=0.0, right=sum_up[-1])
    return upto


def separation_law_of(model: Any, load: float, quantity: str, *, other: bool = False) -> Law:
    """As `analytic.Model.separation_law`, of a model whose asperities are independent."""
    q = quantity_of(quantity)
    if q.counts or q.unloading:
        raise ValueError(
            f"quantity = {quantity!r}: give a sum that decreases with the separation, such as 'load'"
        )
    start = float(model.separation_at(quantity, load))
    _falling(model, quantity, start)
    unit = q.scale(model.surface)
    one, target = one_asperity(model, quantity, start, _CELLS[other]), load / unit
    spread = float(unit * one.usual[1] / model.slope(quantity, start))

    def shares(h: float) -> tuple[float, float]:
        one = one_asperity(model, quantity, h, _CELLS[other], target)
        upto, above = shares_at(one, np.array([target]), _POINTS[other] // 4)
        return float(upto[0]), float(above[0])

    again = partial(separation_law_of, model, load, quantity, other=True)
    return _along(shares, start + other * spread / 7, spread, one.rounding, again)


def shares_upto(model: Any, quantity: str, h: float, most: float) -> Callable[[float, Array], Array]:
    """Return the shares of surfaces of a number of asperities whose sum is no more than some values, SI.

    They are right to 1e-6 or better up to the value `most`. For what is integrated over: one lattice that
    suits the largest of them, without the far tails of a `Law`.
    """
    unit = quantity_of(quantity).scale(model.surface)
    one = one_asperity(model, quantity, h, _CELLS[False], most / unit)

    def shares(number: float, values: Array) -> Array:
        if number < 1:
            return np.where(values >= 0, 1.0, 0.0)
        part = number / one.number
        some = replace(one, number=number, mean=part * one.mean, variance=part * one.variance)
        return shares_at(some, values / unit, _POINTS[False] // 4)[0]

    return shares


def interacting_distribution(model: Any, quantity: str, h: float) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities press each other down."""
    c, alone = model.compliance, model.alone
    if quantity == "nominal_separation":
        return distribution_of(alone, "load", h).mapped(lambda p: h - c * p, falls=c > 0)
    law = distribution_of(alone, quantity, h)
    series = model.series(quantity)

    def together(alone: Array) -> Array:
        """Infinite from the pole on, which no surface reaches."""
        with np.errstate(divide="ignore"):
            return np.asarray(np.divide(alone, np.maximum(1 + series * alone, 0.0)))

    return law.mapped(together) if series else law


def _along(
    shares: Callable[[float], tuple[float, float]],
    start: float,
    spread: float,
    rounding: float,
    again: Callable[[], Any],
) -> Table:
    """The law of y, of which the shares up to y and above are given: by the normal scores of some."""

    def score(y: float) -> float:
        below, above = (max(share, _NONE) for share in shares(y))
        return float(ndtri(below) if below < above else -ndtri(above))

    scores = {start: score(start)}
    for way in (-1, 1):
        at, reached, step = start, scores[start], spread / 4
        while way * reached < _SCORES and at > LOWEST:
            new = max(at + way * step, LOWEST)
            found = score(new)
            apart = abs(found - reached)
            if apart > 1.5 * _APART and step > _SMALLEST * spread:
                step /= 4
                continue
            scores[new] = found
            if way < 0 and apart < _LEVEL:  # all asperities touch, and the rest of the surfaces have none
                break
            step *= float(np.clip(_APART / max(apart, _LEVEL), 0.25, 1.5))
            step = min(step, spread / 3) if way < 0 else step
            at, reached = new, found
    nodes = np.array(sorted(scores))
    z = np.maximum.accumulate([scores[at] for at in nodes.tolist()])
    nodes, z = nodes[np.abs(z) < -ndtri(_NONE)], z[np.abs(z) < -ndtri(_NONE)]
    y = np.interp(np.linspace(0, nodes.size - 1, _TABLE), np.arange(nodes.size), nodes)
    z = np.maximum.accumulate(_interpolated(nodes, z, y))
    table = Table(*resolved(y, ndtr(z), ndtr(-z), rounding), (0.0, 0.0), (-np.inf, np.inf), rounding, again)
    return table.with_moments()


def _interpolated(x: Array, y: Array, at: Array) -> Array:
    """Values between points, by the polynomials through the six nearest (Neville)."""
    n = min(_NEIGHBOURS, x.size)
    which = np.clip(np.searchsorted(x, at) - n // 2, 0, x.size - n)[:, None] + np.arange(n)
    away, found = at[:, None] - x[which], y[which]
    for m in range(1, n):
        left, right = away[:, :-m], away[:, m:]
        found = (left * found[:, 1:] - right * found[:, :-1]) / (left - right)
    return np.asarray(found[:, 0])


def _falling(model: Any, quantity: str, h: float) -> None:
    """Refuse sums that may rise with the separation."""
    rule, added = model.asperities(quantity, h)
    if np.any(added(rule) < 0):
        raise ValueError(
            f"quantity = {quantity!r}: it is negative for some asperities, and sums may increase with the "
            "separation; use a modulus >= 0 and a law without adhesion"
        )
    of, e = model.ways.of(quantity), np.maximum(model.grading(rule.heights), np.finfo(float).tiny)
    for j, limit in enumerate(of.law.limits(e)):
        y = np.sqrt(limit)
        before, after = (of.of_root(quantity, piece, y, e) for piece in (j, j + 1))
        if np.any(after < before * (1 - _ROUNDING)):
            raise ValueError(
                f"quantity = {quantity!r}: it decreases where the law changes to its piece {j + 1}, and sums "
                f"may increase with the separation; use the load"
            )
