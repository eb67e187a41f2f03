"""Gradings, means over separation and load, and their ratios at equal separation and equal load."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

import numpy as np

from analytic import Exponential, quantity_of
from analytic.arrays import Array
from analytic.roots import falling_root
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import SCENE, Compared, Row, grading, pressing, reference, same_load
from mcgw.figures.data import (
    GAMMA,
    PRESSURE,
    SEPARATION,
    Estimate,
    FigureData,
    Panel,
    Points,
    Series,
    quotient_of_sums,
    ratio_of_sums,
)
from mcgw.figures.style import prefixed
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError

Exact = Callable[[str | float, Array], Array]  # of a label or gamma at separations

_BESIDE = 1.5  # sigma above the highest separation that a grading is shown
_AT = np.arange(5.0)  # separations of the paper's ratios
_STIFFER = np.linspace(1, 2, 81), np.array([1.2, 1.4, 1.6, 1.8, 2.0])
_SOFTER = np.linspace(0.2, 1, 81), np.array([0.2, 0.4, 0.6, 0.8])
_GRADES = ("γ = 2", "γ = 1", "γ = 0.5", "γ = 0.2")
_GROUPS = 10  # of surfaces, for the jackknife
_AT_LOAD = np.array([1.0, 2.0, 3.0])
_LINE, _GAMMAS = np.linspace(0.2, 2, 46), np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.5, 2.0])
_SHOWN = ("conductance", "area", "stiffness")


def gradings(f: Compared) -> FigureData:
    """Show the modulus over the height."""
    s = f.line if f.swept else np.linspace(f.h.min(), f.h.max() + _BESIDE, 161)
    panels = [
        Panel(
            title, "summit height s = z/σ", "E*(s)/E*",
            tuple(Series(label, s, f.all[label].modulus(s)) for label in labels),
        )
        for title, labels in (f.groups if f.swept else (("", (SCENE, "homogeneous")),))
    ]  # fmt: skip
    if f.swept:
        caption = "E*(s)/E* = γ − (γ − 1) exp(−s). Theory alone."
        return FigureData("Exponential grading (Eq. 4)", caption, tuple(panels))
    return FigureData("The grading", f.words, tuple(panels))


def load(f: Compared) -> FigureData:
    """Show the load over the separation."""
    return _against_separation(f, "Load at a given separation (Eq. 7)", "load", "pressure", "Pa")


def stiffness(f: Compared) -> FigureData:
    """Show the stiffness over the separation."""
    title = "Stiffness at a given separation; the paper's “conductance”"
    return _against_separation(f, title, "stiffness", "stiffness", "Pa/m")


def _against_separation(f: Compared, title: str, quantity: str, words: str, unit: str) -> FigureData:
    """Means: of a sweep as the paper's integrals, else per nominal area."""
    q, area = quantity_of(quantity), f.scene.surface.nominal_area
    top = max(float(np.abs(f.theory(label, quantity, f.line)).max()) for label in f.all)
    if f.swept:
        size, ylabel = (
            f.scene.n_asperities * q.scale(f.scene.surface),
            rf"{quantity} integral $F^*_{{{2 * q.exponent:g}/2}}$",
        )
    else:
        factor, prefix = prefixed(top / area)
        size, ylabel = area * factor, f"{words} ${q.symbol}/A_n$ ({prefix}{unit})"
    panels = []
    for name, labels in f.groups:
        lines = {label: f.theory(label, quantity, f.line) / size for label in labels}
        positive = all(np.all(line >= 0) and np.any(line > 0) for line in lines.values())
        series = (
            Series(label, f.line, line, f.means(label, quantity, size)) for label, line in lines.items()
        )
        scales = ("linear", "log" if positive else "linear")
        panels.append(Panel(name, SEPARATION, ylabel, tuple(series), scales, None if positive else 0.0))
    return FigureData(title, f.caption, tuple(panels))


def area_per_load(f: Compared) -> FigureData:
    """Show the area per load over the reference's."""

    def exact(key: str | float, h: Array) -> Array:
        area, load = (f.theory(key, name, h) / f.theory(f.reference, name, h) for name in ("area", "load"))
        return area / load

    def drawn(key: str | float) -> Estimate:
        ours, theirs = f.drawn(key), f.drawn(f.reference)
        return quotient_of_sums(*((x.values("area"), x.values("load")) for x in (ours, theirs)))

    return _ratios(f, "Area per load at a given separation (Eq. 12)", r"(A/P)\,/\,(A/P)", exact, drawn)


def _stiffness_ratio(f: Compared) -> tuple[Exact, Callable[[str | float], Estimate]]:
    """Give the stiffness over the reference's, exact and drawn."""

    def exact(key: str | float, h: Array) -> Array:
        return f.theory(key, "stiffness", h) / f.theory(f.reference, "stiffness", h)

    def drawn(key: str | float) -> Estimate:
        return ratio_of_sums(*(f.drawn(x).values("stiffness") for x in (key, f.reference)))

    return exact, drawn


def stiffness_ratios(f: Compared) -> FigureData:
    """Show the stiffness over the reference's."""
    title = "Stiffness at a given separation (Eq. 15: “conductance”)"
    return _ratios(f, title, "K/K", *_stiffness_ratio(f))


def _ratios(
    f: Compared, title: str, symbol: str, exact: Exact, drawn: Callable[[str | float], Estimate]
) -> FigureData:
    """Over gamma, if that is swept, else over the separation."""
    if f.swept:
        parts = (("a  stiffer tips", *_STIFFER), ("b  softer tips", *_SOFTER))
        panels = [
            Panel(
                name, GAMMA, rf"${symbol}_\mathrm{{hom}}$",
                over_gamma(line, gammas, _AT, exact, at_separations(f, _AT, map(drawn, gammas))), level=1.0,
            )
            for name, line, gammas in parts
        ]  # fmt: skip
        return FigureData(title, f.caption, tuple(panels))
    series = tuple(
        Series(label, f.line, exact(label, f.line), f.points(partial(drawn, label), exact(label, f.h)))
        for label in f.others
    )
    panel = Panel("", SEPARATION, rf"${symbol}_\mathrm{{ref}}$", series, level=1.0)
    return FigureData(title, f"Reference: {f.reference}, the same surface. {f.caption}", (panel,))


def at_separations(f: Compared, at: Array, found: Iterable[Estimate]) -> Estimate:
    """Take some separations of estimates at all of them: shape (estimates, separations)."""
    columns = np.searchsorted(f.h, at)
    mean, stderr = np.array([[x[columns] for x in pair] for pair in found]).transpose(1, 0, 2)
    return mean, stderr


def over_gamma(line: Array, gammas: Array, at: Array, exact: Exact, found: Estimate) -> tuple[Series, ...]:
    """Draw lines over gamma, one for each separation, with points of shape (gammas, separations)."""
    curves, truth = (np.array([exact(float(g), at) for g in x]).T for x in (line, gammas))
    mean, stderr = found
    return tuple(
        Series(f"d/σ = {h:g}", line, curves[k], Points(gammas, mean[:, k], stderr[:, k], truth[k]))
        for k, h in enumerate(at)
    )


def area_and_load(f: Compared) -> FigureData:
    """Show the real area over the pressure; of a sweep the local exponent, too."""
    area = f.scene.surface.nominal_area
    areas, exponents = [], []
    for label in _GRADES if f.swept else f.all:
        pressure, fraction = (f.theory(label, name, f.line) / area for name in ("load", "area"))
        points = f.means(label, "area", area)
        if points:
            loads = f.drawn(label).mean("load")[f.enough(f.all[label])]
            points = replace(points, x=loads / area / 1e6)
        areas.append(Series(label, pressure / 1e6, fraction, points))
        if f.swept:
            exponents.append(_exponent(f, label))
    panels = [Panel("", PRESSURE, r"real area fraction $A/A_n$", tuple(areas), ("log", "log"))]
    if not f.swept:
        return FigureData("Real area against load", f.caption, tuple(panels))
    panels = [
        replace(panels[0], title="a  real area"),
        Panel("b  local exponent", SEPARATION, r"$d\,\ln A/d\,\ln P$", tuple(exponents), level=1.0),
    ]
    return FigureData("Real area against load, and its local exponent", f.caption, tuple(panels))


def _exponent(f: Compared, label: str) -> Series:
    """(n/A)/(K/P), to the slope by dA/dd = -pi R n and dP/dd = -K."""
    names, factor = ("contacts", "area", "stiffness", "load"), np.pi * f.scene.surface.radius
    n, a, k, p = (f.drawn(label).values(name) for name in names)

    def exact(h: Array) -> Array:
        n, a, k, p = (f.theory(label, name, h) for name in names)
        return np.asarray(n / a / (k / p) * factor)

    def drawn() -> Estimate:
        mean, stderr = quotient_of_sums((n, a), (k, p))
        return mean * factor, stderr * factor

    return Series(label, f.line, exact(f.line), f.points(drawn, exact(f.h)))


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
    """Return the ensemble at other separations, if its modulus is positive down to them."""
    try:
        return simulate(scene, separations=h)
    except SceneError:
        return None


def _over_gamma(f: Compared) -> FigureData:
    """By theory, and by the listed heights, each gradings' at the load that these very surfaces carry."""
    exact, drawn = _stiffness_ratio(f)
    series = over_gamma(_LINE, _GAMMAS, _AT_LOAD, exact, at_separations(f, _AT_LOAD, map(drawn, _GAMMAS)))
    title = "a  equal separation: stiffness (Eq. 15)"
    panels = [Panel(title, GAMMA, r"$K/K_\mathrm{hom}$", series, level=1.0)]
    found = np.array([_jackknifed(f.listed, float(h)) for h in _AT_LOAD])  # (separation, 2, gamma, quantity)
    for k, name in enumerate(_SHOWN):
        mean, stderr = found[..., k].transpose(1, 2, 0)
        series = over_gamma(_LINE, _GAMMAS, _AT_LOAD, partial(_exact, f, name), (mean, stderr))
        ylabel = _over(name, "hom")
        panels.append(Panel(f"{'bcd'[k]}  equal load: {name}", GAMMA, ylabel, series, level=1.0))
    return FigureData(
        "At equal load the trend reverses: stiffer tips conduct less",
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
    near = h2 - 0.1  # a tenth of the surfaces less moves the separation by less
    parts = np.array([_ratios_at_load(s[group != g], h, near)[0] for g in range(_GROUPS)])
    return whole, np.sqrt((_GROUPS - 1) / _GROUPS * ((parts - parts.mean(axis=0)) ** 2).sum(axis=0))


def _load_beyond(s: Array, modulus: Array, load: float, h: float) -> float:
    """Return how much asperities carry beyond a load, over its scale."""
    return float(modulus @ np.maximum(s - h, 0.0) ** 1.5) - load


def _ratios_at_load(s: Array, h: float, starts: Array) -> tuple[Array, Array]:
    """Conductance, area, stiffness over the homogeneous ones, shape (gammas, 3); the separations."""
    d = s[s > h] - h
    load = float(np.sum(d**1.5))
    hom = np.array([np.sum(np.sqrt(d)), d.sum(), np.sum(np.sqrt(d))])
    rows, found = [], []
    for gamma, start in zip(_GAMMAS, starts, strict=True):
        near = s[s > start]
        modulus = Exponential(float(gamma))(near)
        excess = partial(_load_beyond, near, modulus, load)
        h2 = falling_root(excess, float(start), float(near[0]))
        d = near[near > h2] - h2
        roots = np.sqrt(d)
        rows.append([roots.sum(), d.sum(), modulus[: len(d)] @ roots] / hom)
        found.append(h2)
    return np.array(rows), np.array(found)


FIGURES = (
    Row("figure-1", gradings, (grading,)),
    Row("figure-2", load),
    Row("figure-3", area_per_load, (reference, pressing)),
    Row("figure-5", stiffness),
    Row("figure-6", stiffness_ratios, (reference,)),
    Row("equal-load", equal_load, (reference, pressing, same_load)),
    Row("area-and-load", area_and_load, (pressing,)),
)
