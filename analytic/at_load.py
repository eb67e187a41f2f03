"""Means over finite surfaces under a given load, each at its own separation, without a draw.

A sum Q falls to 0 as a surface is lifted, so ``Q(H) = int_H^inf -Q'(h) dh`` where H is the separation where
its load P is F. P falls too, so that H <= h where P(h) <= F; the mean over surfaces is ::

    E Q(H) = N int dh int ds f(s) [-q'(s - h)] Pr(P_{N-1}(h) <= F - p(s - h))

with q and p what an asperity of height s adds: the others share the load that it leaves (Campbell and
Mecke). It holds for any number of contacts; that of the load itself is F, which checks the quadrature. Where
radii differ the inner integral is over them too. Where a law of contact jumps from piece to piece, an
asperity adds the jump if the others bear what it leaves before: the sum of a surface then passes F without
having it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.arrays import Array
from analytic.distribution.of_model import shares_upto
from analytic.laws.pieces import slope_term
from analytic.measured_summits import MeasuredHeights
from analytic.quadrature import gauss_legendre
from analytic.quantities import quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law

_LIFTS = 24  # nodes in the separation: 1e-6 of the load and better
_MANY, _LIFTS_OF_MANY = 100.0, 16  # contacts from which so many do as well
_RAREST = 1e-9  # share of the surfaces beyond either end of the separations
_DEEPEST = 20.0  # penetration over sigma that no asperity reaches
_PARTS = np.array([0.25, 0.5, 0.75, 1.0])  # of the penetration at which one asperity has all of the load
_HALVINGS = 60


def specimen_means(
    model: Any, given: str, value: float, names: Sequence[str], law: "Law | None" = None
) -> dict[str, float]:
    """Return means over surfaces that all have the same load, or another sum.

    Parameters
    ----------
    model : Model
        Its asperities independent, under a law of contact that never pulls.
    given : str
        The sum that is the same on all surfaces, such as "load".
    value : float
        Its value, SI.
    names : sequence of str
        Sums to average on loading.
    law : Law, optional
        `Model.separation_law` of them, where it was made before.

    Returns
    -------
    dict of str to float
        "separation" (d/sigma) and each of `names`, SI.

    Raises
    ------
    ValueError
        If the law of the separation is not known (see `Model.separation_law`), or some surfaces have none.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-8, E_star=1e9)
    >>> found = specimen_means(analytic.Model(surface), "load", 1e-6, ["load", "contacts"])
    >>> round(found["load"] / 1e-6, 6)
    1.0
    """
    if isinstance(model.heights, MeasuredHeights):
        raise ValueError("heights: means of listed summits at a load are those of drawn surfaces")
    if any(quantity_of(name).base == "load_slope" for name in names):
        raise ValueError("load_slope: its slope is not known; give other quantities")
    law = model.separation_law(value, given) if law is None else law
    low, high = float(law.ppf(_RAREST)), float(law.isf(_RAREST))
    if not np.isfinite(high - low):  # a Poisson number of asperities may be 0
        raise ValueError(f"{given} = {value:g}: not every surface has a separation with it")
    many = float(model.mean("contacts", (low + high) / 2)) > _MANY
    x, w = gauss_legendre(_LIFTS_OF_MANY if many else _LIFTS)
    found = {name: float(model.mean(name, high)) for name in names}
    found["separation"] = high
    lifts = low + (high - low) * x
    deepest = _deepest(model, given, value / quantity_of(given).scale(model.surface), lifts)
    for h, most, width in zip(lifts, deepest, (high - low) * w, strict=True):
        rates, share = _rates(model, given, value, names, float(h), float(most))
        found["separation"] -= float(width * share)
        for name, rate in rates.items():
            found[name] += float(width * rate)
    return found


@dataclass(frozen=True)
class _Added:
    """What asperities add to the given sum at a separation, and to others for each unit that it falls.

    Parameters
    ----------
    given : ndarray
        In the unit of the quantity, shape (m,).
    rates : dict of str to ndarray
        Over the scale, weighted by the probabilities, shape (m,).
    probabilities : ndarray
        Shape (m,); 0 of asperities that jump.
    """

    given: Array
    rates: dict[str, Array]
    probabilities: Array


def _rates(
    model: Any, given: str, value: float, names: Sequence[str], h: float, most: float
) -> tuple[dict[str, float], float]:
    """What the means gain for each unit of separation, and the share of surfaces that are lower.

    No asperity of the surface's radius alone penetrates deeper than `most`.
    """
    rule, added = model.asperities(given, h, most * _PARTS)
    parts = [_pressed(model, given, names, h, rule, added(rule)), *_jumping(model, given, names, h, rule)]
    left = value - np.concatenate([part.given for part in parts])
    others = _others(model)
    *lower, lowest = shares_upto(others, given, h, np.append(np.maximum(left, 0.0), value)).tolist()
    bearable = np.where(left >= 0, lower, 0.0)
    share = lowest
    if others is not model:  # one more asperity beside them, in contact or not
        share = float(rule.below * lowest + np.concatenate([x.probabilities for x in parts]) @ bearable)
    rates = {}
    for name in names:
        rate = float(np.concatenate([part.rates[name] for part in parts]) @ bearable)
        rates[name] = float(model.number * quantity_of(name).scale(model.surface) * rate)
    return rates, share


def _pressed(model: Any, given: str, names: Sequence[str], h: float, rule: Any, terms: Array) -> _Added:
    """Asperities within the pieces of the law."""
    s, branch = rule.heights, model.ways.loading
    if rule.ratios is not None:
        branch = branch.with_radii(rule.ratios)
    modulus, rates = model.grading(s), {}
    for name in names:
        weight = rule.probabilities * _by_radius(name, rule.ratios)
        rates[name] = weight * slope_term(quantity_of(name).base, branch, s - h, modulus)
    return _Added(quantity_of(given).scale(model.surface) * terms, rates, rule.probabilities)


def _jumping(model: Any, given: str, names: Sequence[str], h: float, rule: Any) -> Iterator[_Added]:
    """Asperities that touch, or go on from piece to piece."""
    if not rule.heights.size:
        return
    ends = float(rule.heights.min()), float(rule.heights.max())
    scale, base = quantity_of(given).scale(model.surface), quantity_of(given).base
    for jumps in model.summits.jumps(model.ways.loading, model.grading, np.array([h]), ends):
        rates = {name: jumps.share * jumps.step(quantity_of(name).base) for name in names}
        yield _Added(scale * jumps.before(base), rates, np.zeros(jumps.share.shape))


def _by_radius(name: str, ratios: Array | None) -> Array | float:
    """What a quantity is worth by the radius of an asperity."""
    return 1.0 if ratios is None else np.asarray(ratios ** quantity_of(name).radius)


def _others(model: Any) -> Any:
    """The asperities beside one: of a Poisson number as many as before."""
    if model.count == "poisson" or model.number <= 1:
        return model
    return replace(model, n_asperities=model.number - 1)


def _deepest(model: Any, given: str, target: float, h: Array) -> Array:
    """Penetration at which one asperity alone has the target, over the scale, at each separation."""
    low, high = np.zeros_like(h), np.full_like(h, _DEEPEST)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        s = h + middle
        beyond = model.ways.term(given, h, s, model.grading(s)) > target
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return high
