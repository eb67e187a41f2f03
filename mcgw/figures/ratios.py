"""Gradings, means over separation and load, and their ratios at equal separation and equal load."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.figures.compared import SCENE, Compared, Key, Row
from mcgw.figures.data import (
    GAMMA,
    PRESSURE,
    SEPARATION,
    Estimate,
    FigureData,
    Panel,
    Points,
    Series,
    ratio_of_sums,
)
from mcgw.figures.style import prefixed

Exact = Callable[[Compared, Key, Array], Array]  # of a label or gamma at separations
Drawn = Callable[[Compared, Key, Array], Estimate]

_BESIDE = 1.5  # sigma above the highest separation that a grading is shown
_AT = np.arange(5.0)  # separations of the paper's ratios
_STIFFER = np.linspace(1, 2, 81), np.array([1.2, 1.4, 1.6, 1.8, 2.0])
_SOFTER = np.linspace(0.2, 1, 81), np.array([0.2, 0.4, 0.6, 0.8])
_GRADES = ("γ = 2", "γ = 1", "γ = 0.5", "γ = 0.2")
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


def _exact(f: Compared, key: Key, h: Array, *, name: str, per: str = "") -> Array:
    """Mean of a quantity over the reference's; `per` another one, over that of the reference."""
    found = f.theory(key, name, h) / f.theory(f.reference, name, h)
    return found / _exact(f, key, h, name=per) if per else found


def _drawn(f: Compared, key: Key, h: Array, *, name: str, per: str = "") -> Estimate:
    (own, reference), *other = [[f.values(x, y, h) for x in (key, f.reference)] for y in (name, per) if y]
    return ratio_of_sums([own, *(b for _, b in other)], [reference, *(a for a, _ in other)])


def _of(name: str, per: str = "") -> tuple[Exact, Drawn]:
    return partial(_exact, name=name, per=per), partial(_drawn, name=name, per=per)


_AREA_PER_LOAD, _STIFFNESS = _of("area", "load"), _of("stiffness")


def area_per_load(f: Compared) -> FigureData:
    """Show the area per load over the reference's."""
    title = "Area per load at a given separation (Eq. 12)"
    return _at_separation(f, title, r"(A/P)\,/\,(A/P)", _AREA_PER_LOAD)


def stiffness_ratios(f: Compared) -> FigureData:
    """Show the stiffness over the reference's."""
    title = "Stiffness at a given separation (Eq. 15: “conductance”)"
    return _at_separation(f, title, "K/K", _STIFFNESS)


def _at_separation(f: Compared, title: str, symbol: str, how: tuple[Exact, Drawn]) -> FigureData:
    """Return a panel; of a sweep one for stiffer and one for softer tips."""
    parts = (("a  stiffer tips", _STIFFER), ("b  softer tips", _SOFTER)) if f.swept else (("", _STIFFER),)
    panels = (ratio(f, name, f"${symbol}", *how, *gammas, _AT) for name, gammas in parts)
    reference = "" if f.swept else f"Reference: {f.reference}, the same surface. "
    return FigureData(title, f"{reference}{f.caption}", tuple(panels))


def ratio(
    f: Compared, title: str, symbol: str, exact: Exact, drawn: Drawn, line: Array, gammas: Array, at: Array
) -> Panel:
    """Draw a ratio to the reference over gamma, if that is swept, else over the separation."""
    ylabel = rf"{symbol}_\mathrm{{{'hom' if f.swept else 'ref'}}}$"
    if not f.swept:
        series = tuple(
            Series(label, f.line, exact(f, label, f.line),
                   f.points(partial(drawn, f, label, f.h), exact(f, label, f.h)))
            for label in f.others
        )  # fmt: skip
        return Panel(title, SEPARATION, ylabel, series, level=1.0)
    mean, stderr = np.array([drawn(f, float(gamma), at) for gamma in gammas]).transpose(1, 2, 0)
    curves, truth = (np.array([exact(f, float(gamma), at) for gamma in x]).T for x in (line, gammas))
    series = tuple(
        Series(f"d/σ = {h:g}", line, curves[k], Points(gammas, mean[k], stderr[k], truth[k]))
        for k, h in enumerate(at)
    )
    return Panel(title, GAMMA, ylabel, series, level=1.0)


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
        mean, stderr = ratio_of_sums((n, p), (a, k))
        return mean * factor, stderr * factor

    return Series(label, f.line, exact(f.line), f.points(drawn, exact(f.h)))


def equal_load(f: Compared) -> FigureData:
    """Show conductance, area and stiffness over the reference's, where both carry the same load."""
    panels, keys = [], "abcd"
    if f.swept:
        title = "a  equal separation: stiffness (Eq. 15)"
        panels.append(
            ratio(
                f,
                title,
                "$K/K",
                *_STIFFNESS,
                _LINE,
                _GAMMAS,
                _AT_LOAD,
            )
        )
        keys = "bcd"
    for key, name in zip(keys, _SHOWN, strict=False):
        symbol = quantity_of(name).symbol.removesuffix("ρ")  # the resistivity is that of both
        exact, drawn = partial(_of_load, name=name), partial(_of_load_drawn, name=name)
        title = f"{key}  {'equal load: ' * f.swept}{name}"
        panels.append(ratio(f, title, f"${symbol}/{symbol}", exact, drawn, _LINE, _GAMMAS, _AT_LOAD))
    title = "At equal load the trend reverses: stiffer tips conduct less" if f.swept else "At the same load"
    which = "homogeneous surface" if f.swept else f"reference ({f.reference}, the same surface)"
    return FigureData(title, f"d/σ is that of the {which} and sets the load. {f.caption}", tuple(panels))


def _of_load(f: Compared, key: Key, h: Array, *, name: str) -> Array:
    return f.theory(key, name, f.at_load_of_reference(key, h)) / f.theory(f.reference, name, h)


def _of_load_drawn(f: Compared, key: Key, h: Array, *, name: str) -> Estimate:
    there = f.drawn(key, f.at_load_of_reference(key, h))
    return ratio_of_sums([there.values(name)], [f.values(f.reference, name, h)])


FIGURES = (
    Row("figure-1", gradings, ("grading",)),
    Row("figure-2", load),
    Row("figure-3", area_per_load, ("reference", "pressing")),
    Row("figure-5", stiffness),
    Row("figure-6", stiffness_ratios, ("reference",)),
    Row("equal-load", equal_load, ("reference", "pressing", "same load")),
    Row("area-and-load", area_and_load, ("pressing",)),
)
