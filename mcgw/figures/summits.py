"""How the area grows with the load, which summits carry it, and where their modulus turns negative."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

import analytic
from analytic import Exponential
from mcgw.figures.data import GAMMA, SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.samples import Samples

__all__ = ["area_and_load", "negative_modulus", "who_carries"]

Array = NDArray[np.float64]

_GRADES = (2.0, 1.0, 0.5, 0.2)


def area_and_load(samples: Samples) -> FigureData:
    """Real area against pressure, and the local exponent."""
    line, h = np.linspace(0, 4, 81), samples.base.separations
    share = samples.n_asperities / samples.surface.n_asperities
    pressure, fraction = (1 / (samples.surface.nominal_area * share) for _ in range(2))
    areas, exponents = [], []
    for gamma in _GRADES:
        e, x = Exponential(gamma), samples.graded(gamma)
        label = f"γ = {gamma:g}"
        exact_load = analytic.load(samples.surface, line, e) / samples.surface.nominal_area / 1e6
        exact_area = analytic.area(samples.surface, line) / samples.surface.nominal_area
        points = Points(
            x.mean("load") * pressure / 1e6,
            x.mean("area") * fraction,
            x.stderr("area") * fraction,
            analytic.area(samples.surface, h) / samples.surface.nominal_area,
        )
        areas.append(Series(label, exact_load, exact_area, points))
        slope, stderr = _exponent(*(x.values(name) for name in ("contacts", "area", "stiffness", "load")))
        factor = _exponent_factor(samples.surface)
        points = Points(h, slope * factor, stderr * factor, _exact_exponent(h, gamma))
        exponents.append(Series(label, line, _exact_exponent(line, gamma), points))
    return FigureData(
        "area-and-load",
        "Real area against load, and how far it is from proportional",
        samples.caption,
        (
            Panel(
                "a  real area",
                r"pressure $P/A_n$ (MPa)",
                r"real area fraction $A/A_n$",
                tuple(areas),
                ("log", "log"),
            ),
            Panel("b  local exponent", SEPARATION, r"$d\,\ln A/d\,\ln P$", tuple(exponents), level=1.0),
        ),
    )


def _exact_exponent(h: Array, gamma: float) -> Array:
    e, f = Exponential(gamma), analytic.fn_scaled
    return np.asarray(f(0, h) / f(1, h) / (1.5 * f(0.5, h, e) / f(1.5, h, e)))


def _exponent_factor(surface: analytic.Surface) -> float:
    """(n/A)/(K/P) counted in SI to the slope: dA/dd = -pi R n and dP/dd = -K, by d ln d."""
    return float(np.pi * surface.radius)


def _exponent(contacts: Array, area: Array, stiffness: Array, load: Array) -> tuple[Array, Array]:
    """<n><P>/(<A><K>) and its standard error, by the delta method."""
    parts = (contacts, load, area, stiffness)
    n, p, a, k = (x.mean(axis=0) for x in parts)
    value = n * p / (a * k)
    influence = contacts / n + load / p - area / a - stiffness / k
    return value, value * influence.std(axis=0, ddof=1) / np.sqrt(len(contacts))


def who_carries(samples: Samples) -> FigureData:
    """Modulus and share of the load, by height."""
    h, s = 1.0, np.linspace(0, 4, 161)
    edges = np.arange(1.0, 4.01, 0.25)
    centre = (edges[1:] + edges[:-1]) / 2
    moduli, shares = [], []
    for gamma in (2.0, 1.0, 0.2):
        e, label = Exponential(gamma), f"γ = {gamma:g}"
        moduli.append(Series(label, s, e(s)))
        mean, stderr = _shares(samples.heights, h, e, edges)
        exact = [float(analytic.fn_between(1.5, h, a, b, e)) for a, b in pairwise(edges)]
        points = Points(centre, mean / 0.25, stderr / 0.25, np.array(exact) / 0.25)
        above = np.maximum(s - h, 0.0)
        density = above**1.5 * e(s) * np.exp(-s * s / 2) / np.sqrt(2 * np.pi) / analytic.fn(1.5, h, e)
        shares.append(Series(label, s, density, points))
    return FigureData(
        "who-carries",
        "Which summits carry the load, at d/σ = 1",
        f"Shares in bins of 0.25 σ. {samples.listed_caption}",
        (
            Panel("a  modulus", "summit height s = z/σ", "E*(s)/E*", tuple(moduli)),
            Panel("b  share of the load", "summit height s = z/σ", "share per σ", tuple(shares)),
        ),
        columns=1,
    )


def _shares(
    listed: tuple[Array, ...], h: float, e: Callable[[Array], Array], edges: Array
) -> tuple[Array, Array]:
    """Share of the load in each bin of height, and its standard error."""
    rows, totals = [], []
    for s in listed:
        s = s[s > h]
        loads = (s - h) ** 1.5 * e(s)
        rows.append(np.histogram(s, edges, weights=loads)[0])
        totals.append(loads.sum())
    return ratio_of_sums(np.array(rows), np.array(totals)[:, None])


def negative_modulus() -> FigureData:
    """Heights where the exponential grading is below zero."""
    above = np.linspace(1.02, 4, 150)
    below = np.linspace(-2, -0.02, 100)
    series = (
        Series("negative below this height", above, -np.log(above / (above - 1)), None, "below"),
        Series("negative above this height", below, np.log(1 + 1 / np.abs(below)), None, "above"),
    )
    return FigureData(
        "negative-modulus",
        "Where the modulus turns negative (shaded)",
        "Exponential grading. A scene whose contacts reach the shaded heights is refused, unless it says "
        'negative = "clip" or "allow". γ from 0 to 1 is safe at every height; γ > 1 from d/σ = 0 up. Theory.',
        (Panel("", GAMMA, "summit height s = z/σ", series, ylim=(-4, 4)),),
        columns=1,
    )
