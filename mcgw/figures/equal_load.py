"""What changes at equal load, where nothing may at equal separation."""

import numpy as np
from numpy.typing import NDArray

import analytic
from analytic import Exponential
from mcgw.ensemble.paired import paired_ratio
from mcgw.ensemble.separation import separation_on
from mcgw.figures.data import GAMMA, FigureData, Panel, Points, Series
from mcgw.figures.samples import Samples

__all__ = ["equal_load"]

Array = NDArray[np.float64]

_GROUPS = 10  # of surfaces, for the jackknife
_EQUAL_H = (1.0, 2.0, 3.0)
_EQUAL_GAMMAS = np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.5, 2.0])


def equal_load(samples: Samples) -> FigureData:
    """Ratios to the homogeneous surface, by theory and by listed heights."""
    line = np.linspace(0.2, 2, 46)
    at_separation = tuple(
        Series(f"d/σ = {h:g}", line, _exact_stiffness(h, line), _stiffness_points(samples, h))
        for h in _EQUAL_H
    )
    title = "a  equal separation: stiffness (Eq. 15)"
    panels = [Panel(title, GAMMA, r"$K/K_\mathrm{hom}$", at_separation, level=1.0)]
    found = {h: _jackknifed(samples.heights, h) for h in _EQUAL_H}
    for k, (key, name, symbol) in enumerate(
        (("b", "conductance", "C"), ("c", "area", "A"), ("d", "stiffness", "K"))
    ):
        series = []
        exact, curves = _exact_equal(name, _EQUAL_GAMMAS), _exact_equal(name, line)
        for i, h in enumerate(_EQUAL_H):
            mean, stderr = found[h]
            points = Points(_EQUAL_GAMMAS, mean[:, k], stderr[:, k], exact[i])
            series.append(Series(f"d/σ = {h:g}", line, curves[i], points))
        title = f"{key}  equal load: {name}"
        panels.append(Panel(title, GAMMA, rf"${symbol}/{symbol}_\mathrm{{hom}}$", tuple(series), level=1.0))
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


def _exact_equal(name: str, gammas: Array) -> Array:
    """Shape (separations, gammas)."""
    return np.transpose([analytic.ratio_at_equal_load(name, _EQUAL_H, Exponential(float(g))) for g in gammas])


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
