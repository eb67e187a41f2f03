"""The exact law of a finite surface: of a sum over its asperities, and of the separation, without a draw.

One asperity adds a value X, the sum S over N of them has the transform ``(1 + q)^N``, or ``exp(N q)`` where
their number is a Poisson variable, with ``q(z) = E exp(-z X) - 1``. One FFT gives it on a lattice; a positive
real part of z damps the sums beyond its end (Grübel and Hermesmeier, ASTIN Bulletin 29 (1999) 197).
Surfaces on which no asperity touches, or one, are counted apart, by the distribution of X itself.
"""

import math
from collections.abc import Sequence
from functools import cache, cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.special import log1p, ndtr, ndtri  # NumPy's log1p loses digits of small complex numbers

from analytic.arrays import Array
from analytic.curvature import MEAN_CURVATURE
from analytic.distribution import Counted, Law
from analytic.height_rule import HeightRule
from analytic.mean_model import LOWEST
from analytic.measured_summits import MeasuredHeights
from analytic.quantities import quantity_of

_POINTS = 2**15, 5 * 2**13  # of a lattice, and of another one
_CELLS = 12_288, 20_480  # of the heights, by the root of the probability, and as many evenly between nodes
_STENCIL = range(-3, 4)  # lattice points that share a value and keep its moments up to the sixth
_MARGIN = 16  # lattice points below the lowest sum
_REACH = 9.0  # standard deviations that hold all but 1e-18
SCORES = 6.0  # normal scores that are looked for


class OneAsperity:
    """What one of a number of asperities adds: shares of them, each evenly between two values."""

    def __init__(self, ends: tuple[Array, Array], shares: Array, number: float, poisson: bool) -> None:
        low, high = np.minimum(*ends), np.maximum(*ends)
        order = np.argsort(low + high)
        order = order[(((low != 0) | (high != 0)) & (shares > 0))[order]]
        self.low, self.high, self.shares = low[order], high[order], shares[order]
        self.middle = (self.low + self.high) / 2
        self.number, self.poisson = number, poisson
        self.touching = min(float(self.shares.sum()), 1.0)
        self.none = math.exp(-number * self.touching) if poisson else (1 - self.touching) ** number
        others = self.none if poisson else (1 - self.touching) ** (number - 1)
        self.alone = number * others  # asperities that touch alone on their surface, over the share

    @cached_property
    def distribution(self) -> tuple[Array, Array]:
        """Values, and the share of asperities that touch and add no more: linear in between."""
        median = np.interp(self.touching / 2, np.cumsum(self.shares), np.abs(self.middle))
        single = 1e-9 * (median + np.abs(self.high))  # width of a single value
        width = np.maximum(self.high - self.low, single)
        density, places = self.shares / width, np.concatenate([self.high - width, self.high])
        order = np.argsort(places)
        slopes = np.cumsum(np.concatenate([density, -density])[order], dtype=np.longdouble)[:-1]
        places = places[order]
        return places, np.append(0.0, np.cumsum(slopes * np.diff(places))).astype(np.float64)

    @cached_property
    def span(self) -> tuple[float, float, float]:
        """Lowest sum, highest one of surfaces without rare large values, longest step of a lattice."""
        x, p, n = self.middle, self.shares, self.number
        rarer = n * np.cumsum(p[::-1])[::-1]
        usual, pull = np.where(rarer > min(1e-2, rarer[0] / 2), x, 0.0), np.minimum(x, 0.0)
        means, squares = ((p * np.stack([usual, pull]) ** k).sum(axis=1) for k in (1, 2))
        spread = np.sqrt(n * np.maximum(squares - (0.0 if self.poisson else means**2), 0.0))
        deepest = pull[min(int(np.searchsorted(n * np.cumsum(p), 1e-9)), x.size - 1)]  # fewer pull more
        low = (n * means - _REACH * spread).max() + 2 * deepest
        high = n * means[0] + _REACH * spread[0] + max(usual.max(), 0.0)
        return float(low), float(high), np.inf if self.alone > 1e-25 else float(spread[0]) / 12

    def upto(self, x: Array, end: float, points: int) -> Array:
        """Return the shares of surfaces in contact with sums up to x, by a lattice to there or beyond."""
        low, size = self.span[0], 2 * points
        step, k = (end - low) / points, np.arange(size)
        first = np.floor(low / step) - _MARGIN
        signed = np.where(k < 3 * points // 2, k, k - size)
        places = self.middle / step
        kept = (places < points + 2 * _MARGIN) & (places > -points / 2)
        near, p, f = np.rint(places[kept]), self.shares[kept], np.zeros(size)
        lost = float(self.shares[~kept].sum())
        damping = 20.0 / size  # by exp(-20) over a period, of which half is read
        if np.isfinite(self.span[2]) and lost <= 1e-15 * self.touching:  # it would only take digits
            damping = 0.0
        off, at = places[kept] - near, near.astype(np.int64)
        for i in _STENCIL:  # by Lagrange's weights
            weights = np.prod([(off - j) / (i - j) for j in _STENCIL if j != i], axis=0)
            f += np.bincount((at + i) % size, p * weights, size)
        centre = float((f * signed).sum())
        f[[1, -1]] -= centre / 2, -centre / 2  # apart from what scatters: it takes digits where N is large
        f[0] = 0.0
        f[0] = -f.sum() - lost  # so that many small values lose no digits
        scatter, z = np.fft.rfft(f * np.exp(-damping * signed)), damping + 2j * np.pi / size * k[: points + 1]
        q = scatter - centre * np.sinh(z)
        log = q + centre * z - (0.0 if self.poisson else q - log1p(q))
        spectrum = np.exp(self.number * log + z * (first - self.number * centre))
        if self.alone:
            spectrum -= (self.none + self.alone * (q + self.touching)) * np.exp(z * first)
        read = k[: points + 2 * _MARGIN]
        p = np.fft.irfft(spectrum, size)[read] * np.exp(damping * read)
        several = np.interp(x, (first + read) * step, np.cumsum(p) - p / 2, left=0.0)
        one = np.interp(x, *self.distribution, left=0.0, right=self.touching)
        return np.asarray(several + self.alone * one)

    def table(self, points: int) -> tuple[Array, Array]:
        """Return sums and shares of surfaces up to them, by ever wider lattices; a jump is a sum twice."""
        if not self.low.size:
            return np.zeros(2), np.array([0.0, 1.0])
        rounding = 5e-12 * max(math.sqrt(self.number * self.touching), 1.0)
        own, x, upto, (low, usual, step) = self.distribution[0], np.zeros(0), np.zeros(0), self.span
        begin, wide, widest = low, (usual - low) * 32.0 ** np.arange(-1, 4), max(points * step, usual - low)
        least = -low if np.isinf(step) else usual - low
        for end in low + wide[(wide >= least) & (wide <= widest)]:
            new = np.union1d(np.linspace(low, end, points), own[:: max(1, 2 * own.size // points)])
            new = np.union1d(new[(new > begin) & (new <= end)], [0.0] if begin <= 0 else [])
            x, upto, begin = np.append(x, new), np.append(upto, self.upto(new, end, points)), end
            if upto[-1] > 1 - self.none - rounding:
                break
        at, upto = int(np.searchsorted(x, 0.0)), np.maximum.accumulate(upto)
        if self.low.min() >= 0:  # no rounding beside the surfaces that nothing touches
            upto[: at + 1] = 0.0
        x, upto = np.insert(x, at, 0.0), np.insert(upto, at, upto[at])
        upto[at + 1 :] += self.none
        upto = np.clip(upto, rounding, 1 - rounding)
        first, last = np.searchsorted(upto, upto[0], "right"), np.searchsorted(upto, upto[-1])
        return x[max(first - 1, 0) : last + 1], upto[max(first - 1, 0) : last + 1]


def distribution_of(model: Any, quantity: str, h: float, other: bool = False) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities are independent."""
    q = quantity_of(quantity)
    if q.counts:
        from scipy.stats import binom, poisson  # takes long to import

        mean, n = float(model.mean(quantity, h)), model.number
        return Counted(poisson(mean) if model.count == "poisson" else binom(round(n), mean / n))
    one, unit = one_asperity(model, quantity, h, _CELLS[other]), q.scale(model.surface)
    x, upto = one.table(_POINTS[other])
    ends = (-np.inf if one.low.min(initial=0) < 0 else 0.0, np.inf)
    known = model.cumulants(quantity, h)
    moments = float(known.mean), float(known.variance)
    return Law(unit * x, upto, ends, partial(distribution_of, model, quantity, h, other=True), moments)


def shares_upto(
    model: Any, quantity: str, h: float, number: float, values: Array, *, other: bool = False
) -> Array:
    """Return shares, to 1e-6, or a bound, of surfaces of so many asperities with sums up to values, SI."""
    if number < 1:
        return np.where(values >= 0, 1.0, 0.0)
    one = one_asperity(model, quantity, h, _CELLS[other] // 4, number)
    x, points = values / quantity_of(quantity).scale(model.surface), _POINTS[other] // 8
    low, usual, step = one.span if one.low.size else (0.0, 0.0, 0.0)
    if x.max() <= low or not one.low.size:
        return np.where((x >= 0) & (x >= low), 1.0, 0.0)
    end = float(np.clip(x.max(), low if np.isinf(step) else usual, max(usual, low + points * step)))
    return one.upto(x, end, points) + one.none * (x >= 0)


def one_asperity(model: Any, quantity: str, h: float, cells: int, number: float | None = None) -> OneAsperity:
    """Return what one asperity adds, over the scale of the quantity, by cells of heights."""
    rule, lowest = model.rule([h], [quantity]), min(h, model.ways.of(quantity).lowest(h))
    at_nodes = rule.terms([quantity], [h], model.grading, model.ways)
    low, high, shares = in_cells(model, [quantity], h, rule, at_nodes, cells, lowest)
    return OneAsperity((low[:, 0], high[:, 0]), shares, number or model.number, model.count == "poisson")


def in_cells(
    model: Any, several: Sequence[str], h: float, rule: HeightRule, at_nodes: Array, cells: int, lowest: float
) -> tuple[Array, Array, Array]:
    """Return what asperities add, (cells, quantities), at both ends of cells between nodes, and shares."""
    s, p, ratios = rule.heights, rule.probabilities, rule.ratios
    if not p.any() or isinstance(model.heights, MeasuredHeights):  # cells of no width
        return at_nodes, at_nodes, p
    root, radius = np.sqrt(p), np.zeros(p.size) if ratios is None else ratios
    parts = np.ceil(cells * (root / root.sum() + 1 / root.size)).astype(np.int64)
    first = np.append(True, np.diff(radius) != 0)  # height of a radius
    start = np.where(first, max(lowest, model.heights.support[0]), np.append(0.0, s[:-1]))
    wide = np.repeat((s - start) / parts, parts)
    number = np.arange(wide.size) - np.repeat(np.cumsum(parts) - parts, parts)  # of a cell below its node
    left = np.repeat(start, parts) + number * wide
    middle, which, radius = left + wide / 2, np.cumsum(first) - 1, np.repeat(radius, parts)
    if ratios is None:
        own = wide * model.heights.pdf(middle)
    else:
        own = wide * model.curvature.density(middle, MEAN_CURVATURE / radius)
    whole, which = np.bincount(which, p), np.repeat(which, parts)  # each radius keeps its share
    own *= (whole / np.bincount(which, own))[which]
    at = np.concatenate([left + 1e-9 * wide, left + wide])  # right of where contacts begin
    nodes = HeightRule(at, 0 * at, rule.below, None if ratios is None else np.tile(radius, 2))
    low, high = np.split(nodes.terms(several, [h], model.grading, model.ways), 2)
    missing, size = 2 * p @ at_nodes - own @ (low + high), own @ (np.abs(low) + np.abs(high))
    share = missing / np.where(size > 0, size, 1.0)
    return low + share * np.abs(low), high + share * np.abs(high), own


def separation_law_of(model: Any, load: float, quantity: str, *, other: bool = False) -> Law:
    """As `analytic.Model.separation_law`, of a model whose asperities are independent."""
    from scipy.interpolate import make_interp_spline  # takes long to import

    q = quantity_of(quantity)
    if q.counts or q.unloading:
        raise ValueError(
            f"quantity = {quantity!r}: give a sum that decreases with the separation, such as 'load'"
        )
    h, z = normal_scores(model, quantity, load, apart=0.4, other=other)
    x = np.interp(np.linspace(0, len(h) - 1, 8192), np.arange(len(h)), h)
    smooth = np.maximum.accumulate(make_interp_spline(h, z, min(5, len(h) - 1))(x))
    x, upto = x[np.abs(smooth) < SCORES], ndtr(smooth[np.abs(smooth) < SCORES])
    again = partial(separation_law_of, model, load, quantity, other=True)
    return Law(x, upto, (-np.inf, np.inf), again)


def normal_scores(
    model: Any, quantity: str, value: float, *, apart: float = math.inf, other: bool = False
) -> tuple[list[float], list[float]]:
    """Return separations, and normal scores, at most so far `apart`, of shares with sums up to a value."""
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
            "may increase with the separation; use the load"
        )

    @cache
    def score(h: float) -> float:
        share = shares_upto(model, quantity, h, model.number, np.array([value]), other=other)
        return float(np.clip(ndtri(np.clip(share[0], 0.0, 1.0)), -SCORES - 0.5, SCORES + 0.5))

    spread = float(model.std(quantity, start) / model.slope(quantity, start))  # to first order
    places, step, moved = [start + other * spread / 7], spread / (3 if apart < math.inf else 1), 1.0
    while score(places[-1]) < SCORES:  # far, where tails are heavy
        places.append(places[-1] + step * 1.25 ** len(places))
    # if shares move no more, the surfaces that are left have no asperity
    while score(places[0]) > -SCORES and moved > 1e-9 and places[0] > LOWEST:
        places.insert(0, max(places[0] - step, LOWEST))
        moved = score(places[1]) - score(places[0])
    while between := [
        (left + right) / 2
        for left, right in pairwise(places)
        if score(right) - score(left) > apart and right - left > 1e-3 * spread
    ]:
        places = sorted([*places, *between])
    return places, [score(h) for h in places]
