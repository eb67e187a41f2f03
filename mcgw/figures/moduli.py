"""The modulus of contacts: its means, the summits that carry the load, and where it is negative."""

from itertools import pairwise

import numpy as np

import analytic
from analytic import Exponential, Grading, mean_modulus
from analytic.arrays import Array
from mcgw.figures.compared import Compared, of_gamma
from mcgw.figures.data import GAMMA, SEPARATION, Estimate, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.ratios import over_gamma

_PSI = r"$\psi/\psi_\mathrm{hom}$"
_POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}
_LINE = np.linspace(0.2, 2, 73)
_GAMMAS = np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 1.6, 1.8, 2.0])
_AT = np.arange(5.0)
_TITLES = {
    "number": "b  mean over the contacts",
    "area": "c  weighted by area",
    "load": "d  weighted by load",
}


def mean_moduli(f: Compared) -> FigureData:
    """Show the mean modulus of the contacts, which the plasticity index goes as."""
    title = "Plasticity index over that of the homogeneous surface"
    if f.swept:
        return FigureData(title, f.listed_caption, _over_gamma(f))
    plain = f.hertz and f.scene.curvature is None  # else area and load of a contact are not powers
    series = []
    for weight in _POWERS if plain else ("number",):
        line, at = (_exact(f, weight, f.scene.modulus, h) for h in (f.line, f.h))
        label = "contacts" if weight == "number" else weight
        series.append(Series(label, f.line, line, _points(f, weight, at)))
    panel = Panel("", SEPARATION, _PSI, tuple(series), level=1.0)
    said = (
        f"Mean over the contacts, each weighted alike (contacts){', by its area, or by its load' * plain}. "
    )
    return FigureData(title, said + f.listed_caption, (panel,))


def _over_gamma(f: Compared) -> tuple[Panel, ...]:
    just = tuple(Series(f"d/σ = {h:g}", _LINE, _LINE - (_LINE - 1) * np.exp(-h)) for h in _AT)
    panels = [Panel("a  as in the paper: just touching, s = d/σ", GAMMA, _PSI, just, level=1.0)]
    for weight, title in _TITLES.items():

        def exact(gamma: str | float, h: Array, weight: str = weight) -> Array:
            return _exact(f, weight, Exponential(float(gamma)), h)

        found = [_drawn(f, weight, Exponential(float(g)), _AT) for g in _GAMMAS]
        mean, stderr = np.array(found).transpose(1, 0, 2)
        series = over_gamma(_LINE, _GAMMAS, _AT, exact, (mean, stderr))
        panels.append(Panel(title, GAMMA, _PSI, series, level=1.0))
    return tuple(panels)


def _exact(f: Compared, weight: str, modulus: Grading, h: Array) -> Array:
    asked = {"weight": weight, "heights": f.scene.heights}
    return mean_modulus(h, modulus, **asked)  # type: ignore[arg-type]


def _points(f: Compared, weight: str, exact: Array) -> Points | None:
    """Points from the listed heights, where there are enough."""
    if len(f.listed) < 2:
        return None
    known = f.enough(f.scene.replace(n_surfaces=len(f.listed)))
    if not known.any():
        return None
    return Points(f.h[known], *_drawn(f, weight, f.scene.modulus, f.h[known]), exact[known])


def _drawn(f: Compared, weight: str, modulus: Grading, h: Array) -> Estimate:
    """Mean of E*(s)/E* over the contacts of the listed surfaces."""
    above, below = np.zeros((2, len(f.listed), len(h)))
    for i, s in enumerate(f.listed):
        for k, separation in enumerate(h):
            touching = s[s > separation]
            e = modulus(touching)
            weights = (touching - separation) ** _POWERS[weight] * (e if weight == "load" else 1.0)
            above[i, k], below[i, k] = np.sum(weights * e), np.sum(weights)
    return ratio_of_sums(above, below)


def carriers(f: Compared) -> FigureData:
    """Show modulus and share of the load, by height."""
    h, s = 1.0, np.linspace(0, 4, 161)
    edges = np.arange(1.0, 4.01, 0.25)
    centre = (edges[1:] + edges[:-1]) / 2
    moduli, shares = [], []
    for gamma in (2.0, 1.0, 0.2):
        e, label = Exponential(gamma), of_gamma(gamma)
        moduli.append(Series(label, s, e(s)))
        mean, stderr = _shares(f.listed, h, e, edges)
        exact = [float(analytic.fn_between(1.5, h, a, b, e)) for a, b in pairwise(edges)]
        points = Points(centre, mean / 0.25, stderr / 0.25, np.array(exact) / 0.25)
        above = np.maximum(s - h, 0.0)
        density = above**1.5 * e(s) * np.exp(-s * s / 2) / np.sqrt(2 * np.pi) / analytic.fn(1.5, h, e)
        shares.append(Series(label, s, density, points))
    return FigureData(
        "Which summits carry the load, at d/σ = 1",
        f"Shares in bins of 0.25 σ. {f.listed_caption}",
        (
            Panel("a  modulus", "summit height s = z/σ", "E*(s)/E*", tuple(moduli)),
            Panel("b  share of the load", "summit height s = z/σ", "share per σ", tuple(shares)),
        ),
        columns=1,
    )


def _shares(listed: tuple[Array, ...], h: float, e: Grading, edges: Array) -> Estimate:
    """Share of the load in each bin of height."""
    rows, totals = [], []
    for s in listed:
        s = s[s > h]
        loads = (s - h) ** 1.5 * e(s)
        rows.append(np.histogram(s, edges, weights=loads)[0])
        totals.append(loads.sum())
    return ratio_of_sums(np.array(rows), np.array(totals)[:, None])


def negative_modulus(_: Compared) -> FigureData:
    """Show the heights where the exponential grading is below zero."""
    end = 4.0
    above, below = np.linspace(1.02, end, 150), np.linspace(-2, -0.02, 100)
    low, high = -np.log(above / (above - 1)), np.log(1 + 1 / np.abs(below))
    series = (
        Series("negative below this height", above, low, band=(np.full_like(low, -end), low)),
        Series("negative above this height", below, high, band=(high, np.full_like(high, end))),
    )
    return FigureData(
        "Where the modulus turns negative (shaded)",
        "Exponential grading. A scene whose contacts reach the shaded heights needs "
        'negative = "clip" or "allow". γ from 0 to 1 is safe at every height; γ > 1 from d/σ = 0 up. Theory.',
        (Panel("", GAMMA, "summit height s = z/σ", series, ylim=(-end, end)),),
    )
