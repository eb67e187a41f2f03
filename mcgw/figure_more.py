"""Numbers of the figures that the paper lacks."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

import analytic
from analytic import QUANTITIES, Exponential
from mcgw.figure_data import FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figure_paper import Samples
from mcgw.regrade import paired_ratio
from mcgw.simulation import simulate
from mcgw.solution import separation_on

__all__ = ["law_of_load", "more_figures"]

Array = NDArray[np.float64]

_GROUPS = 10  # of surfaces, for the jackknife
_FINE = 2048  # steps of the exact law in a bin: rounding each contact to a step shifts the mean by 1e-4
_EQUAL_H = (1.0, 2.0, 3.0)
_EQUAL_GAMMAS = np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.5, 2.0])
_GRADES = (2.0, 1.0, 0.5, 0.2)
_GAMMA = "grading factor γ"
_SEPARATION = "separation d/σ"


def more_figures(samples: Samples) -> list[FigureData]:
    """Ratios at equal load, fluctuations, distribution, area against load, who carries, where it ends.

    Parameters
    ----------
    samples : Samples
        The surfaces.

    Returns
    -------
    list of FigureData
        In order.
    """
    return [
        _equal_load(samples),
        _fluctuations(samples),
        _distribution(samples),
        _area_and_load(samples),
        _who_carries(samples),
        _negative_modulus(),
    ]


def _equal_load(samples: Samples) -> FigureData:
    line = np.linspace(0.2, 2, 46)
    at_separation = tuple(
        Series(f"d/σ = {h:g}", line, _exact_stiffness(h, line), _stiffness_points(samples, h))
        for h in _EQUAL_H
    )
    title = "a  equal separation: stiffness (Eq. 15)"
    panels = [Panel(title, _GAMMA, r"$K/K_\mathrm{hom}$", at_separation, level=1.0)]
    found = {h: _jackknifed(samples.heights, h) for h in _EQUAL_H}
    for k, (key, name, symbol) in enumerate(
        (("b", "conductance", "C"), ("c", "area", "A"), ("d", "stiffness", "K"))
    ):
        series = []
        for h in _EQUAL_H:
            mean, stderr = found[h]
            points = Points(_EQUAL_GAMMAS, mean[:, k], stderr[:, k], _exact_equal(name, h, _EQUAL_GAMMAS))
            series.append(Series(f"d/σ = {h:g}", line, _exact_equal(name, h, line), points))
        title = f"{key}  equal load: {name}"
        panels.append(Panel(title, _GAMMA, rf"${symbol}/{symbol}_\mathrm{{hom}}$", tuple(series), level=1.0))
    return FigureData(
        "equal-load",
        "At equal load the trend turns round: stiffer tips conduct less",
        f"d/σ is that of the homogeneous surface and sets the load. {samples.listed_caption} "
        f"(a: {samples.n_surfaces} surfaces.)",
        tuple(panels),
    )


def _exact_stiffness(h: float, gammas: Array) -> Array:
    return np.array([float(analytic.stiffness_ratio(h, Exponential(float(g)))) for g in gammas])


def _stiffness_points(samples: Samples, h: float) -> Points:
    """Paired ratios of the regraded ensemble."""
    k = samples.base.scene.separations.index(h)
    pairs = [paired_ratio(samples.graded(float(g)), samples.base, "stiffness") for g in _EQUAL_GAMMAS]
    mean, stderr = np.array([(pair.ratio[k], pair.stderr[k]) for pair in pairs]).T
    return Points(_EQUAL_GAMMAS, mean, stderr, _exact_stiffness(h, _EQUAL_GAMMAS))


def _exact_equal(name: str, h: float, gammas: Array) -> Array:
    return np.array([float(analytic.ratio_at_equal_load(name, h, Exponential(float(g)))) for g in gammas])


def _jackknifed(listed: tuple[Array, ...], h: float) -> tuple[Array, Array]:
    """Ratios (gamma, quantity) at the load of all listed surfaces, and their errors by leaving groups out."""
    s = np.concatenate(listed)
    group = np.repeat(np.arange(len(listed)) % _GROUPS, [len(x) for x in listed])
    order = np.argsort(-s)
    s, group = s[order], group[order]
    s, group = s[s > h - 0.9], group[s > h - 0.9]  # what any of the gradings brings into contact
    whole, h2 = _ratios_at_load(s, h, np.full(len(_EQUAL_GAMMAS), h - 0.85))
    near = h2 - 0.02  # a tenth of the surfaces less moves the separation by far less
    parts = np.array([_ratios_at_load(s[group != g], h, near)[0] for g in range(_GROUPS)])
    return whole, np.sqrt((_GROUPS - 1) / _GROUPS * ((parts - parts.mean(axis=0)) ** 2).sum(axis=0))


def _ratios_at_load(s: Array, h: float, starts: Array) -> tuple[Array, Array]:
    """Conductance, area, stiffness over the homogeneous ones, shape (gammas, 3); the separations."""
    d = s[s > h] - h
    load = float(np.sum(d**1.5))
    hom = np.array([np.sum(np.sqrt(d)), d.sum(), np.sum(np.sqrt(d))])
    rows, found = [], []
    for gamma, start in zip(_EQUAL_GAMMAS, starts, strict=True):
        near = s[s > start]
        modulus = Exponential(float(gamma))(near)
        h2 = separation_on(near, modulus, 1.5, load, float(start))
        d = near[near > h2] - h2
        roots = np.sqrt(d)
        rows.append([roots.sum(), d.sum(), modulus[: len(d)] @ roots] / hom)
        found.append(h2)
    return np.array(rows), np.array(found)


def _fluctuations(samples: Samples) -> FigureData:
    h, line = np.linspace(0, 4, 9), np.linspace(0, 4, 41)
    scene = replace(
        samples.base.scene, keep="sums", separations=tuple(h), quantities=("load", "area", "stiffness")
    )
    sizes = {n: min(2000, 400_000_000 // n) for n in (100, 10_000, 1_000_000)}
    drawn = {n: simulate(replace(scene, n_asperities=n, n_surfaces=m)) for n, m in sizes.items()}
    panels = []
    for key, name in zip("abc", scene.quantities, strict=True):
        series = []
        for n in (100, 1000, 10_000, 100_000, 1_000_000):
            points = _spread_points(drawn[n].values(name), h, name, n, samples) if n in drawn else None
            series.append(Series(f"N = {_power(n)}", line, _exact_spread(name, line, n, samples), points))
        panels.append(
            Panel(f"{key}  {name}", _SEPARATION, "std / mean", tuple(series), ("linear", "log"), level=1.0)
        )
    return FigureData(
        "fluctuations",
        "How far finite surfaces differ from each other",
        f"N asperities a surface; 2000 surfaces (400 of N = 10⁶), seed {samples.seed}. Markers, with "
        "95 % intervals, where the ensemble has 400 contacts or more.",
        tuple(panels),
        columns=3,
    )


def _power(n: int) -> str:
    return "10" + "⁰¹²³⁴⁵⁶"[len(str(n)) - 1]


def _exact_spread(name: str, h: Array, n: int, samples: Samples) -> Array:
    c = analytic.cumulants(samples.surface, name, h, n_asperities=n)
    return np.asarray(np.sqrt(c.variance) / c.mean)


def _spread_points(x: Array, h: Array, name: str, n: int, samples: Samples) -> Points:
    """std/mean where enough asperities touch, with the standard error of its influence function."""
    known = x.shape[0] * n * analytic.fn(0, h) >= 400
    x, h = x[:, known], h[known]
    mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
    z = (x - mean) / std
    influence = std / mean * ((z**2 - 1) / 2 - z * std / mean)
    return Points(h, std / mean, influence.std(axis=0) / np.sqrt(len(x)), _exact_spread(name, h, n, samples))


def law_of_load(n: int, h: float, step: float, bins: int) -> Array:
    """Exact law of the load of a finite homogeneous surface, by Fourier transform.

    Parameters
    ----------
    n : int
        Asperities.
    h : float
        Reduced separation.
    step : float
        Width of a bin of load, over that of one asperity at unit approach.
    bins : int
        How many; the load must hardly ever exceed ``step * bins``.

    Returns
    -------
    ndarray
        Probability of a load within half a step of ``k step``, shape (bins,).
    """
    edges = (np.arange(bins) + 0.5) * step
    below = ndtr(-(h + edges ** (2 / 3)))  # of an approach beyond the edge
    one = -np.diff(below, prepend=1.0)
    return np.fft.irfft(np.fft.rfft(one) ** n, bins)


def _distribution(samples: Samples) -> FigureData:
    panels = tuple(
        _load_panel(samples, key, contacts) for key, contacts in (("a", 5.0), ("b", 50.0), ("c", 500.0))
    )
    return FigureData(
        "distribution",
        "Load of one finite surface at light contact (d/σ = 2.5)",
        f"Homogeneous; 100 000 surfaces, seed {samples.seed}. Solid: exact law; dashed: Gaussian of the same "
        "mean and std.",
        panels,
        columns=3,
    )


def _load_panel(samples: Samples, key: str, contacts: float) -> Panel:
    h, m = 2.5, 100_000
    n = round(contacts / float(analytic.fn(0, h)))
    scene = replace(
        samples.base.scene, keep="sums", separations=(h,), quantities=("load",), n_asperities=n, n_surfaces=m
    )
    exact = analytic.cumulants(scene.surface, "load", h, n_asperities=n)
    mean, std = float(exact.mean), float(np.sqrt(exact.variance))
    x = simulate(scene).load[:, 0] / mean
    width = std / mean / 4
    top = 1 + 5 * std / mean
    edges = np.arange(max(width * round((1 - 4 * std / mean) / width), width), top, width)
    step = width * mean / QUANTITIES["load"].scale(scene.surface) / _FINE
    law = law_of_load(n, h, step, 2**18)
    cumulative = np.concatenate([[0.0], np.cumsum(law)])  # up to (k - 1/2) steps
    at = np.interp(edges / width * _FINE + 0.5, np.arange(len(cumulative)), cumulative)
    share, p = np.histogram(x, edges)[0] / m, np.diff(at)
    often = p * m >= 25  # a bin with fewer has no symmetric interval
    share, p, centre = share[often], p[often], ((edges[1:] + edges[:-1]) / 2)[often]
    points = Points(centre, share / width, np.sqrt(p * (1 - p) / m) / width, p / width)
    fine = np.linspace(max(0.0, 2 - top), top, 201)
    bell = np.exp(-(((fine - 1) * mean / std) ** 2) / 2) / np.sqrt(2 * np.pi) * mean / std
    none = f"; no contact: {float(np.exp(n * np.log1p(-analytic.fn(0, h)))):.1%}" if contacts < 10 else ""
    return Panel(
        f"{key}  {contacts:g} contacts{none}",
        r"load over its mean, $P/\langle P\rangle$",
        "probability density",
        (Series("exact", centre, p / width, points), Series("Gaussian", fine, bell)),
    )


def _area_and_load(samples: Samples) -> FigureData:
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
            Panel("b  local exponent", _SEPARATION, r"$d\,\ln A/d\,\ln P$", tuple(exponents), level=1.0),
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


def _who_carries(samples: Samples) -> FigureData:
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


def _negative_modulus() -> FigureData:
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
        (Panel("", _GAMMA, "summit height s = z/σ", series, ylim=(-4, 4)),),
        columns=1,
    )
