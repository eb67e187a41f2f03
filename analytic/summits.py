"""Summits of different radii in sums over heights: weighted heights, and rules over height and radius."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from analytic.curvature import MEAN_CURVATURE, RandomCurvature
from analytic.gauss_legendre import gauss_legendre
from analytic.height_rule import Fluctuations, HeightRule
from analytic.laws.law import ContactLaw
from analytic.quantities import quantity_of
from analytic.weighted_heights import WeightedHeights

if TYPE_CHECKING:
    from analytic.model import Model

__all__ = ["of_each_radius", "over_radii", "random_fluctuations", "separations_of_means"]

Array = NDArray[np.float64]

_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_WIDEST = 20.0  # distance of a separation from that of one radius
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out


def random_fluctuations(model: "Model", quantities: Sequence[str], h: Array, *, powers: bool) -> Fluctuations:
    """What one asperity of random curvature adds to each quantity at each separation, over its scale.

    Parameters
    ----------
    model : Model
        With a curvature.
    quantities : sequence of str
        Their names.
    h : ndarray
        Reduced separations, shape (k,).
    powers : bool
        Whether an asperity adds powers of its approach and of its radius.
    """
    assert isinstance(model.curvature, RandomCurvature)
    radius = np.repeat([quantity_of(name).radius for name in quantities], h.size)
    if powers:
        rule = _with_radii(model.rule(h, quantities), model.curvature)
        terms = rule.terms(quantities, h, model.grading)
    else:
        rule, terms = _of_all_radii(model, quantities, h)
    result = rule.fluctuations(terms, model.count)
    return replace(result, radius=radius) if np.isinf(model.curvature.largest) else result


def _with_radii(rule: HeightRule, curvature: RandomCurvature) -> HeightRule:
    """Rule over heights and radii of summits.

    Exact for sums, their products and third powers where one summit adds a power of its radius, up to 1;
    fourth powers of the radius have a mean only if it is bounded.
    """
    ratio, probability = curvature.rule(rule.heights)
    heights = np.broadcast_to(rule.heights, ratio.shape)
    return HeightRule(heights.ravel(), (rule.probabilities * probability).ravel(), rule.below, ratio.ravel())


def of_each_radius(model: "Model", separations: Array) -> list[tuple[float, "Model"]]:
    """Models of one radius each whose weighted sum is that of a model of random curvature.

    Its sums over a surface, means as well as those of products, are integrals over the curvature, in the
    root of which they are smooth: the heights at which a contact changes its law depend on the radius alone.

    Parameters
    ----------
    model : Model
        With a curvature.
    separations : ndarray
        That are asked for.

    Returns
    -------
    list of (float, Model)
        Weight and model; flatter summits than the flattest are one of them.
    """
    law = model.curvature
    assert isinstance(law, RandomCurvature)
    nayak = law.heights
    top = float(nayak.from_above(np.array(_RAREST), float(np.max(separations, initial=0.0))))
    first = np.sqrt(MEAN_CURVATURE / law.largest)
    last = max(np.sqrt(law.steepest(top)), first)
    x, w = gauss_legendre(int(np.ceil(_NODES * max(1.0, _AS_WIDE / law.narrowest))))
    roots, weights = first + (last - first) * x, (last - first) * w
    found = []
    for root, weight in zip(roots.tolist(), weights.tolist(), strict=True):
        ratio, density = MEAN_CURVATURE / root**2, partial(law.density, root**2)
        found.append((2 * root * weight, _of_one(model, ratio, density)))
    if first > 0:
        found.append((1.0, _of_one(model, law.largest, partial(law.below, first**2))))
    return found


def _of_one(model: "Model", ratio: float, weight: Callable[[Array], Array]) -> "Model":
    """The summits of one radius, whose heights count with a weight."""
    assert isinstance(model.curvature, RandomCurvature)
    surface = replace(model.surface, radius=ratio * model.surface.radius)
    heights = WeightedHeights(model.heights, weight, model.curvature.narrowest)
    law = None if model.law is None else _on_radius(model.law.on(model.surface), ratio)
    return replace(
        model, surface=surface, heights=heights, curvature=None, law=law, n_asperities=model.number
    )


def _on_radius(law: ContactLaw, ratio: float) -> ContactLaw:
    """A law in reduced units, in those of a summit whose radius is so many times the surface's."""
    if not law.of_radius:
        return law
    name, power = law.of_radius
    return replace(law, **{name: getattr(law, name) * ratio**power})  # type: ignore[type-var]


def over_radii(model: "Model", h: Array, what: "Callable[[Model], Array]") -> Array:
    """Sum of something over models of one radius each; shape of `h`."""
    return np.asarray(sum(weight * what(one) for weight, one in of_each_radius(model, h)))


def _of_all_radii(model: "Model", quantities: Sequence[str], h: Array) -> tuple[HeightRule, Array]:
    """Rule over heights and radii under any law of contact, and what is added at each of its points."""
    rules, columns = [], []
    unit = np.array([quantity_of(name).scale(model.surface) for name in quantities])
    for weight, one in of_each_radius(model, h):
        rule = one.rule(h, quantities)
        own = np.array([quantity_of(name).scale(one.surface) for name in quantities])
        terms = rule.terms(quantities, h, model.grading, one.ways)
        rules.append((rule.heights, weight * rule.probabilities))
        columns.append(terms * np.repeat(own / unit, h.size))
    heights, probabilities = (np.concatenate(part) for part in zip(*rules, strict=True))
    return HeightRule(heights, probabilities, rule.below), np.concatenate(columns)


def separations_of_means(model: "Model", quantity: str, values: Array) -> Array:
    """Separations with given means under any law of contact, looked for around those of one radius.

    Raises
    ------
    ValueError
        If a value is not reached.
    """
    from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

    one, found = replace(model, curvature=None), []
    for value in values.ravel().tolist():

        def excess(h: float, value: float = value) -> float:
            with np.errstate(divide="ignore"):
                return float(np.fmax(np.log(model.mean(quantity, h) / value), -100.0))

        middle, width = float(one.separation_at(quantity, value)), 0.25
        while not excess(middle - width) > 0 > excess(middle + width):
            width *= 2
            if width > _WIDEST:
                raise ValueError(f"{quantity}: {value:g} is not reached; give another value")
        found.append(brentq(excess, middle - width, middle + width, xtol=1e-13, rtol=1e-14))
    return np.array(found, dtype=np.float64).reshape(values.shape)
