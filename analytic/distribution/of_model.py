"""The laws of the quantities of a model."""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.special import gammaln, xlogy

from analytic.distribution.derived import Along, Counted, Law, Mapped
from analytic.distribution.distribution import Distribution
from analytic.distribution.one_asperity import OneAsperity
from analytic.distribution.touching import Asperity, Touching
from analytic.height_rule import HeightRule
from analytic.measured_summits import MeasuredHeights
from analytic.quantities import quantity_of

_FARTHER = (1.0, 3.0, 6.0, 10.0)  # heights above the separation that divide the rule, and reach on
_ROUNDING = 1e-9  # of a law that goes on smoothly
_FINER = (0.5, 1.0, 2.0, 3.0, 4.5, 6.0, 8.0, 10.0)


def distribution_of(model: Any, quantity: str, h: float) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities are independent."""
    q, poisson = quantity_of(quantity), model.count == "poisson"
    if q.counts:
        return Counted(float(model.mean(quantity, h) / model.number), model.number, poisson)
    rule, added = model.asperities(quantity, h, _FARTHER)

    def one(rule: HeightRule) -> OneAsperity:
        return OneAsperity.of(added(rule), rule.probabilities, model.number, poisson)

    listed = isinstance(model.heights, MeasuredHeights)
    mixed = model.curvature is not None and model.law is not None  # breaks of every radius for itself
    itself = None if listed or mixed else Asperity(model, quantity, h, rule, added)
    finer = partial(model.asperities, quantity, h, _FINER)
    touching = Touching(one(rule), lambda: one(finer()[0]), itself)
    if listed:  # how often a surface has each of them, the likeliest way
        often = model.number * touching.one.probabilities
        k = np.floor(often)
        touching = replace(touching, step=float(np.exp(np.sum(xlogy(k, often) - often - gammaln(k + 1)))))
    return Distribution(touching, q.scale(model.surface))


def separation_law_of(model: Any, load: float, quantity: str) -> Law:
    """As `analytic.Model.separation_law`, of a model whose asperities are independent."""
    if quantity_of(quantity).counts or quantity_of(quantity).unloading:
        raise ValueError(
            f"quantity = {quantity!r}: give a sum that decreases with the separation, such as 'load'"
        )
    start = float(model.separation_at(quantity, load))
    _falling(model, quantity, start)
    spread = float(model.std(quantity, start) / model.slope(quantity, start))
    return Along(partial(distribution_of, model, quantity), lambda _: load, start, spread)


def interacting_distribution(model: Any, quantity: str, h: float) -> Law:
    """As `analytic.Model.distribution`, of a model whose asperities press each other down."""
    c, alone, q = model.compliance, model.alone, quantity_of(quantity)
    if not model.interaction.nominal:
        if quantity == "nominal_separation":
            return Mapped(
                distribution_of(alone, "load", h), lambda p: h - c * p, lambda x: (h - x) / c, falls=c > 0
            )
        if si := model.series(quantity):
            of = distribution_of(alone, quantity, h)
            return Mapped(of, lambda k: k / (1 + si * k), lambda k: k / (1 - si * k))
        return distribution_of(alone, quantity, h)
    if c < 0:
        raise ValueError(
            f"quantity = {quantity!r}: its exact distribution at nominal separations from the mean plane is "
            "not known, because a surface may have several equilibria; use effective separations"
        )
    if q.base != "load" or q.unloading:
        if quantity != "effective_separation":
            raise ValueError(
                f"quantity = {quantity!r}: at nominal separations only the distributions of 'load', "
                "'pressure' and 'effective_separation' are known; use effective separations for others"
            )
        return Mapped(interacting_distribution(model, "load", h), lambda p: h + c * p, lambda x: (x - h) / c)
    each = c * alone.surface.nominal_area if q.of else c  # of d/sigma for each unit of the quantity
    _falling(alone, quantity, h)
    felt = float(model.effective(h))
    start, spread = float(alone.mean(quantity, felt)), float(alone.std(quantity, felt))
    return Along(lambda p: distribution_of(alone, quantity, h + each * p), lambda p: p, start, spread)


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
