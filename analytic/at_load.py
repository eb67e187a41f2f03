"""Means over finite surfaces under a given load, each at its own separation, without a draw.

A sum Q falls to 0 as a surface is lifted, so ``Q(H) = int_H^inf -Q'(h) dh`` where H is the separation where
its load P is F. P falls too, so that H <= h where P(h) <= F; the mean over surfaces is ::

    E Q(H) = N int dh int ds f(s) [-q'(s - h)] Pr(P_{N-1}(h) <= F - p(s - h))

with q and p what an asperity of height s adds: the others share the load that it leaves (Campbell and
Mecke). It holds for any number of contacts; that of the load itself is F, which checks the quadrature.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.arrays import Array
from analytic.distribution.of_model import shares_upto
from analytic.quadrature import gauss_legendre
from analytic.quantities import quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law

_LIFTS, _DEPTHS = 24, 32  # nodes in the separation, in the penetration at each: 1e-6 of the load and better
_MANY, _LIFTS_OF_MANY = 100.0, 16  # contacts from which so many do as well
_RAREST = 1e-9  # share of the surfaces beyond either end of the separations
_STEP = 1e-4  # of a difference, over the penetration
_DEEPEST = 20.0  # penetration over sigma that no asperity reaches
_HALVINGS = 60


def specimen_means(
    model: Any, given: str, value: float, names: Sequence[str], law: "Law | None" = None
) -> dict[str, float]:
    """Return means over surfaces that all have the same load, or another sum.

    Parameters
    ----------
    model : Model
        Under Hertz's law, its summits of one radius.
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


def _rates(
    model: Any, given: str, value: float, names: Sequence[str], h: float, most: float
) -> tuple[dict[str, float], float]:
    """What the means gain for each unit of separation, and the share of surfaces that are lower.

    No asperity alone penetrates deeper than `most`.
    """
    unit = quantity_of(given).scale(model.surface)
    x, w = gauss_legendre(_DEPTHS)
    depth, weight = most * x**2, 2 * most * x * w  # roots of the penetration: all terms are smooth in them
    s = h + depth
    modulus, density = model.grading(s), weight * model.heights.pdf(s)
    left = np.maximum(value - unit * model.ways.term(given, h, s, modulus), 0.0)
    rest = _others(model)
    *lower, lowest = shares_upto(rest, given, h, np.append(left, value)).tolist()
    share, bearable = lowest, density * np.array(lower)
    if rest is not model:  # one more asperity beside them, in contact or not
        share = float((1 - model.heights.sf(np.array(h))) * share + np.sum(bearable))
    rates = {}
    for name in names:
        if quantity_of(name).counts:  # begins with a step
            rates[name] = float(model.number * model.heights.pdf(np.array(h)) * lowest)
            continue
        step = _STEP * depth
        rise = model.ways.term(name, h - step, s, modulus) - model.ways.term(name, h + step, s, modulus)
        scale = model.number * quantity_of(name).scale(model.surface)
        rates[name] = float(scale * np.sum(bearable * rise / (2 * step)))
    return rates, share


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
