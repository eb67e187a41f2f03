"""Means and scatter of finite surfaces under a given load, each at its own separation, without a draw.

A sum Q falls to 0 as a surface is lifted, so ``Q(H) = int_H^inf -Q'(h) dh`` where H is the separation where
its load P is F. P falls too, so that H <= h where P(h) <= F; the mean over surfaces is ::

    E Q(H) = N int dh int ds f(s) [-q'(s - h)] Pr(P_{N-1}(h) <= F - p(s - h))

with q and p what an asperity of height s adds: the others share the load that it leaves (Campbell and
Mecke). It holds for any number of contacts; that of the load itself is F, which tells how many nodes h needs.
Where radii differ the inner integral is over them too. Rates are differences, so that an asperity that goes
on to the next piece of a law adds its jump if the others bear what it leaves before: the sum of a surface
then passes F without having it, and its mean is a little more than F.

In the mean of the square, ``-(Q^2)' = -2 Q Q'``, the others count with their own share of Q besides: that
asperity has q(s), and each of the N - 1 others q(t) where the last N - 2 bear what both leave.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from analytic.arrays import Array
from analytic.exact_law import SCORES, in_cells, normal_scores, shares_upto
from analytic.measured_summits import MeasuredHeights
from analytic.quadrature import gauss_legendre
from analytic.quantities import quantity_of

_PARTS = np.array([0.25, 0.5, 0.75, 1.0])  # of the penetration at which one asperity has all of the load
_GRID = 4096  # points of the given sum, over which others bear it


class Moments(NamedTuple):
    """Means and standard deviations over surfaces, of "separation" (d/sigma) and of sums, SI, by name."""

    mean: dict[str, float]
    std: dict[str, float]


def specimen_moments(model: Any, given: str, value: float, names: Sequence[str]) -> Moments:
    """Return means and standard deviations over surfaces that all have the same load, or another sum.

    Of the separation, the given sum and others on loading. Means are right to 2e-6 mostly, to 1e-3 at worst
    where heights have heavy tails or a law jumps at the load; standard deviations to 5e-4 of the mean. A
    ValueError if the law of the separation is not known (see `Model.separation_law`), or some surfaces have
    none; of one asperity alone; and if the given sum is not found again.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-8, E_star=1e9)
    >>> found = specimen_moments(analytic.Model(surface), "load", 1e-3, ["load", "contacts"])
    >>> round(found.mean["load"] / 1e-3, 6)
    1.0
    """
    if isinstance(model.heights, MeasuredHeights):
        raise ValueError("heights: means of listed summits at a load are those of drawn surfaces")
    if any(quantity_of(name).base == "load_slope" for name in names):
        raise ValueError("load_slope: its slope is not known; give other quantities")
    if model.count == "fixed" and model.number < 2:
        raise ValueError(f"n_asperities = {model.number:g}: give 2 or more; no other bears what one leaves")
    places, scores = normal_scores(model, given, value)  # fewer than a law needs: they place nodes
    if scores[0] > -SCORES or scores[-1] < SCORES:  # a Poisson number of asperities may be 0
        raise ValueError(f"{given} = {value:g}: not every surface has a separation with it")
    ends = np.interp([-SCORES, 0.0, SCORES], np.maximum.accumulate(scores), places).tolist()
    several, found, contacts = [given, *names], np.zeros(2), float(model.mean("contacts", ends[1]))
    last = _at_last(model, several, value, ends[-1])
    for times in (1, 2, 4):
        mean, std = _integrated(model, several, value, ends, last, times * (16 if contacts > 100 else 24))
        before, found = found, np.array([mean[1], math.hypot(mean[1], std[1])]) / value
        missed = min(abs(found - 1).max(), abs(found - before).max())  # a law with jumps passes it
        if missed < 2e-6:
            break
    if missed > 1e-3:
        raise ValueError(f"{given} = {value:g}: its mean is found to {missed:.1g} only; draw surfaces")
    keys = ["separation", *several]
    return Moments(*(dict(zip(keys, values.tolist(), strict=True)) for values in (mean, std)))


def _at_last(model: Any, several: Sequence[str], value: float, high: float) -> tuple[Array, Array]:
    """Means and variances of the separation and of each sum, of surfaces that are not above the last one."""
    (alone,) = _deepest(model, several[0], value, np.array([high]))
    mean, square = _gains(model, several, value, high, float(alone))[1]
    variance = square - mean**2
    of_all, std = (np.array([float(of(name, high)) for name in several]) for of in (model.mean, model.std))
    if np.allclose([mean, square], [of_all, of_all**2 + std**2], rtol=1e-6, atol=0):  # known to more digits
        mean, variance = of_all, std**2
    return np.append(high, mean), np.append(0.0, variance)


def _integrated(
    model: Any, several: Sequence[str], value: float, ends: list[float], last: tuple[Array, Array], nodes: int
) -> tuple[Array, Array]:
    """Means and standard deviations of the separation and of each sum, from those at the last separation."""
    (low, middle, high), (start, variance), change = ends, last, np.zeros_like(last[0])
    x, w = gauss_legendre(nodes)  # as many on each side of the middle, closer in the shorter half
    u, ratio = 2 * x - 1, math.log((high - middle) / (middle - low))
    unit = (high - middle) / (math.expm1(ratio) / ratio if ratio else 1.0)
    places = middle + unit * (np.expm1(ratio * u) / ratio if ratio else u)
    widths = 2 * w * unit * np.exp(ratio * u)
    alone = _deepest(model, several[0], value, places)
    for h, width, penetration in zip(places.tolist(), widths, alone.tolist(), strict=True):
        lower, _, (rates, of_squares) = _gains(model, several, value, h, penetration)
        change += width * np.append(-lower, rates)
        squares = np.append(2 * (high - h) * lower, of_squares - 2 * start[1:] * rates)
        variance = variance + width * squares
    return start + change, np.sqrt(np.maximum(variance - change**2, 0.0))


def _gains(
    model: Any, several: Sequence[str], value: float, h: float, alone: float
) -> tuple[float, Array, Array]:
    """Share of surfaces lower than a separation; means and mean squares of sums there; rates of these."""
    n, poisson, given = model.number, model.count == "poisson", several[0]
    one, two = (0, 0) if poisson else (1, 2)  # of a Poisson number there are as many beside one
    step = 3e-4 * min(1 / (1 + abs(h)), alone)  # of differences
    at = h - step * np.arange(3)

    def parts(ratios: Array) -> Array:
        """Heights that are cut besides: beyond the highest an asperity alone has more than all."""
        own = _deepest(model, given, value, np.full(ratios.size, h), ratios) if model.curvature else [alone]
        return np.asarray(h + np.multiply.outer(_PARTS, own))

    rule = model.rule(at, several, parts)
    units = np.array([quantity_of(name).scale(model.surface) for name in several])[:, None]
    terms = rule.terms(several, at, model.grading, model.ways).reshape(-1, len(several), at.size)
    values = np.moveaxis(terms * units, 0, -1)  # here, one and two steps on: shape (several, 3, heights)
    means, squares = (rule.probabilities * values**k for k in (1, 2))
    low, high, own = in_cells(model, several, h, rule, terms[..., 0], 3072, float(at[-1]))
    cells = (low + high).T / 2 * units  # what asperities add in cells
    sum_of, square = (float(n * each[0, 0].sum()) for each in (means, squares))
    spread = math.sqrt(square if poisson else max(square - sum_of**2 / n, 0.0))
    start = max(min(sum_of, value) - 12 * spread, 0.0)
    width = (value - start) / (_GRID - 1)
    bear = shares_upto(model, given, h, n - two, np.asarray(start + width * np.arange(_GRID)))
    left, none = (value - start - np.append(values[0, 0], 0.0)) / width, bear[0] if start == 0 else 0.0
    beside = _beside(left, cells[0] / width, bear, none)
    bears = np.interp(left, np.arange(_GRID), bear, left=0.0)
    bearable = bears if poisson else beside(own) + rule.below * bears
    others = np.array([(n - one) * beside(own * each)[:-1] for each in cells])

    def over_surfaces(weights: Array, pairs: int) -> Array:
        """Sum what asperities add, by weights of the steps, to means and, with others, to mean squares."""
        added, of_squares = (weights @ each for each in (means, squares))
        with_others = pairs * np.einsum("ij,ij->i", added, others)
        return np.asarray(n * np.array([added @ bearable[:-1], of_squares @ bearable[:-1] + with_others]))

    lower = bearable[-1] if poisson else np.append(rule.probabilities, rule.below) @ bearable
    rate = np.array([-3.0, 4.0, -1.0]) / (2 * step)
    return float(lower), over_surfaces(np.array([1.0, 0.0, 0.0]), 1), over_surfaces(rate, 2)


def _beside(left: Array, cells: Array, bear: Array, none: float) -> Callable[[Array], Array]:
    """Return sums of weights of a second asperity, where all others bear what it and the first one leave."""
    spectrum, order, points = np.fft.rfft(bear - none, 2 * _GRID), np.argsort(cells), np.arange(_GRID)
    inside = np.flatnonzero(cells < _GRID - 1)
    at = cells[inside].astype(np.int64)
    part = cells[inside] - at

    def sums(weights: Array) -> Array:
        w, in_order = weights[inside], weights[order]
        shared = np.bincount(at, w * (1 - part), _GRID) + np.bincount(at + 1, w * part, _GRID)
        both = np.fft.irfft(np.fft.rfft(shared, 2 * _GRID) * spectrum, 2 * _GRID)[:_GRID]
        alone = np.interp(left, cells[order], np.cumsum(in_order) - in_order / 2, left=0.0)
        return np.asarray(np.interp(left, points, both, left=0.0) + none * alone)

    return sums


def _deepest(model: Any, given: str, value: float, h: Array, ratios: Array | None = None) -> Array:
    """Penetrations over sigma at which one asperity alone has a value, by separation and ratio of radii."""
    penetrations, own = np.geomspace(1e-12, 20.0, 2048), model.ways.of(given)
    own = own if ratios is None else own.with_radii(ratios)
    s = h + penetrations[:, None]
    added = own.terms([given], h, s, model.grading(s))[0] * quantity_of(given).scale(model.surface)
    columns = np.log(np.maximum(added, 1e-300)).T  # next to linear in the logarithm of the penetration
    return np.exp([np.interp(math.log(value), column, np.log(penetrations)) for column in columns])
