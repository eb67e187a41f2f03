"""What changes at equal load, where nothing may at equal separation."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from analytic import Exponential, quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.separation import separation_on
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import Compared
from mcgw.figures.curves import at_separations, over_gamma, stiffness_ratio
from mcgw.figures.data import GAMMA, SEPARATION, FigureData, Panel, Series, ratio_of_sums
from mcgw.scene.scene import Scene, SceneError

__all__ = ["equal_load"]

Array = NDArray[np.float64]

_GROUPS = 10  # of surfaces, for the jackknife
_AT = np.array([1.0, 2.0, 3.0])
_LINE, _GAMMAS = np.linspace(0.2, 2, 46), np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.5, 2.0])
_SHOWN = ("conductance", "area", "stiffness")


def equal_load(f: Compared) -> FigureData:
    """Show conductance, area and stiffness over the reference's, where both carry the same load."""
    return _over_gamma(f) if f.swept else _over_separation(f)


def _over(name: str, reference: str) -> str:
    symbol = quantity_of(name).symbol.removesuffix("ρ")  # the resistivity is that of both
    return rf"${symbol}/{symbol}_\mathrm{{{reference}}}$"


def _exact(f: Compared, name: str, key: str | float, h: Array) -> Array:
    return f.theory(key, name, f.at_load_of_reference(key, h)) / f.theory(f.reference, name, h)


def _over_separation(f: Compared) -> FigureData:
    drawn = {label: _drawn_at(f.all[label], f.at_load_of_reference(label, f.h)) for label in f.others}
    panels = []
    for key, name in zip("abc", _SHOWN, strict=True):
        here, series = f.drawn(f.reference).values(name), []
        for label, there in drawn.items():
            exact, curve = (_exact(f, name, label, h) for h in (f.h, f.line))
            points = f.points(partial(ratio_of_sums, there.values(name), here), exact) if there else None
            series.append(Series(label, f.line, curve, points))
        ylabel = _over(name, "ref")
        panels.append(Panel(f"{key}  {name}", SEPARATION, ylabel, tuple(series), level=1.0))
    caption = f"d/σ is that of the reference ({f.reference}, the same surface) and sets the load. {f.caption}"
    return FigureData("At the same load", caption, tuple(panels))


def _drawn_at(scene: Scene, h: Array) -> Ensemble | None:
    """The ensemble at other separations, if its modulus is positive down to them."""
    try:
        return simulate(scene, separations=h)
    except SceneError:
        return None


def _over_gamma(f: Compared) -> FigureData:
    """By theory, and by the listed heights, each gradings' at the load that these very surfaces carry."""
    exact, drawn = stiffness_ratio(f)
    series = over_gamma(_LINE, _GAMMAS, _AT, exact, at_separations(f, _AT, map(drawn, _GAMMAS)))
    title = "a  equal separation: stiffness (Eq. 15)"
    panels = [Panel(title, GAMMA, r"$K/K_\mathrm{hom}$", series, level=1.0)]
    found = np.array([_jackknifed(f.listed, float(h)) for h in _AT])  # (separation, 2, gamma, quantity)
    for k, name in enumerate(_SHOWN):
        mean, stderr = found[..., k].transpose(1, 2, 0)
        series = over_gamma(_LINE, _GAMMAS, _AT, partial(_exact, f, name), (mean, stderr))
        ylabel = _over(name, "hom")
        panels.append(Panel(f"{'bcd'[k]}  equal load: {name}", GAMMA, ylabel, series, level=1.0))
    return FigureData(
        "At equal load the trend turns round: stiffer tips conduct less",
        f"d/σ is that of the homogeneous surface and sets the load. {f.listed_caption} "
        f"(a: {f.scene.n_surfaces} surfaces.)",
        tuple(panels),
    )


def _jackknifed(listed: tuple[Array, ...], h: float) -> tuple[Array, Array]:
    """Ratios (gamma, quantity) at the load of all listed surfaces, and their errors by leaving groups out."""
    s = np.concatenate(listed)
    group = np.repeat(np.arange(len(listed)) % _GROUPS, [len(x) for x in listed])
    order = np.argsort(-s)
    s, group = s[order], group[order]
    s, group = s[s > h - 0.9], group[s > h - 0.9]  # what any of the gradings brings into contact
    whole, h2 = _ratios_at_load(s, h, np.full(len(_GAMMAS), h - 0.85))
    near = h2 - 0.02  # a tenth of the surfaces less moves the separation by far less
    parts = np.array([_ratios_at_load(s[group != g], h, near)[0] for g in range(_GROUPS)])
    return whole, np.sqrt((_GROUPS - 1) / _GROUPS * ((parts - parts.mean(axis=0)) ** 2).sum(axis=0))


def _ratios_at_load(s: Array, h: float, starts: Array) -> tuple[Array, Array]:
    """Conductance, area, stiffness over the homogeneous ones, shape (gammas, 3); the separations."""
    d = s[s > h] - h
    load = float(np.sum(d**1.5))
    hom = np.array([np.sum(np.sqrt(d)), d.sum(), np.sum(np.sqrt(d))])
    rows, found = [], []
    for gamma, start in zip(_GAMMAS, starts, strict=True):
        near = s[s > start]
        modulus = Exponential(float(gamma))(near)
        h2 = separation_on(near, modulus, 1.5, load, float(start))
        d = near[near > h2] - h2
        roots = np.sqrt(d)
        rows.append([roots.sum(), d.sum(), modulus[: len(d)] @ roots] / hom)
        found.append(h2)
    return np.array(rows), np.array(found)
