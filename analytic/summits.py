"""Summits of random curvature: those of one radius each, and rules over height and radius."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from analytic.curvature import MEAN_CURVATURE, RandomCurvature
from analytic.gauss_legendre import gauss_legendre
from analytic.height_rule import HeightRule
from analytic.laws.law import ContactLaw

__all__ = ["at_each_radius", "on_radius", "separations_of_means", "with_radii"]

Array = NDArray[np.float64]

_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_WIDEST = 20.0  # distance of a separation from that of one radius
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out


def with_radii(rule: HeightRule, curvature: RandomCurvature) -> HeightRule:
    """Spread a rule over heights to heights and radii of summits.

    Exact for sums, their products and third powers where one summit adds a power of its radius, up to 1;
    fourth powers of the radius have a mean only if it is bounded.
    """
    ratio, probability = curvature.rule(rule.heights)
    heights = np.broadcast_to(rule.heights, ratio.shape)
    return HeightRule(heights.ravel(), (rule.probabilities * probability).ravel(), rule.below, ratio.ravel())


def at_each_radius(
    curvature: RandomCurvature, separations: Array
) -> list[tuple[float, float, Callable[[Array], Array]]]:
    """Split summits of random curvature into those of one radius each.

    Sums over a surface, means as well as those of products, are integrals over the curvature, in the root
    of which they are smooth: the heights at which a contact changes its law depend on the radius alone.

    Parameters
    ----------
    curvature : RandomCurvature
        Their law.
    separations : ndarray
        That are asked for.

    Returns
    -------
    list of (float, float, callable)
        Weight in the sum, radius over the mean one, and how much a height counts; flatter summits than the
        flattest are one of them.
    """
    top = float(curvature.heights.from_above(np.array(_RAREST), float(np.max(separations, initial=0.0))))
    first = np.sqrt(MEAN_CURVATURE / curvature.largest)
    last = max(np.sqrt(curvature.steepest(top)), first)
    x, w = gauss_legendre(int(np.ceil(_NODES * max(1.0, _AS_WIDE / curvature.narrowest))))
    roots, weights = first + (last - first) * x, (last - first) * w
    found: list[tuple[float, float, Callable[[Array], Array]]] = [
        (2 * root * weight, MEAN_CURVATURE / root**2, partial(curvature.density, root**2))
        for root, weight in zip(roots.tolist(), weights.tolist(), strict=True)
    ]
    if first > 0:
        found.append((1.0, curvature.largest, partial(curvature.below, first**2)))
    return found


def on_radius(law: ContactLaw, ratio: float) -> ContactLaw:
    """Give a law in reduced units in those of a summit whose radius is so many times the surface's."""
    if not law.of_radius:
        return law
    name, power = law.of_radius
    return replace(law, **{name: getattr(law, name) * ratio**power})  # type: ignore[type-var]


def separations_of_means(mean: Callable[[float], Array], starts: Array, values: Array, name: str) -> Array:
    """Find the separations of given means, looking around those of one radius.

    Parameters
    ----------
    mean : callable
        Takes a separation to the mean, which falls.
    starts, values : ndarray
        Where to begin, and what is looked for; of one shape.
    name : str
        Of the quantity, for the message.

    Raises
    ------
    ValueError
        If a value is not reached.
    """
    from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

    found = []
    for middle, value in zip(starts.ravel().tolist(), values.ravel().tolist(), strict=True):

        def excess(h: float, value: float = value) -> float:
            with np.errstate(divide="ignore"):
                return float(np.fmax(np.log(mean(h) / value), -100.0))

        width = 0.25
        while not excess(middle - width) > 0 > excess(middle + width):
            width *= 2
            if width > _WIDEST:
                raise ValueError(f"{name}: {value:g} is not reached; give another value")
        found.append(brentq(excess, middle - width, middle + width, xtol=1e-13, rtol=1e-14))
    return np.array(found, dtype=np.float64).reshape(values.shape)
