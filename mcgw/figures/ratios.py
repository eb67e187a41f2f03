"""Gradings, means over separation and load, and their ratios at equal separation and equal load."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.figures.compared import SCENE, Compared, Key
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
    return FigureData("The grading", f.caption_of(0), tuple(panels))


def against_separation(f: Compared, *, title: str, quantity: str, words: str, unit: str) -> FigureData:
    """Show means: of a sweep as the paper's integrals, else per nominal area."""
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


@dataclass(frozen=True)
class Ratio:
    """Mean of a quantity over the reference's: at the same separation, or where both carry the same load.

    Parameters
    ----------
    name : str
        The quantity.
    per : str, optional
        Another one, over which both are.
    at_load : bool, optional
        Whether separations are those of the reference, and the load is the same.
    """

    name: str
    per: str = ""
    at_load: bool = False

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        """By theory, for a label or gamma at separations."""
        there = f.at_load_of_reference(key, h) if self.at_load else h
        found = f.theory(key, self.name, there) / f.theory(f.reference, self.name, h)
        return found / Ratio(self.per).exact(f, key, h) if self.per else found

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """By Monte Carlo."""
        above, below = [], [f.values(f.reference, self.name, h)]
        if self.at_load:
            above.append(f.drawn(key, f.at_load_of_reference(key, h)).values(self.name))
        else:
            above.append(f.values(key, self.name, h))
        if self.per:
            above.append(f.values(f.reference, self.per, h))
            below.append(f.values(key, self.per, h))
        return ratio_of_sums(above, below)


def at_separation(f: Compared, *, title: str, symbol: str, how: Ratio) -> FigureData:
    """Show a ratio; of a sweep a panel for stiffer and one for softer tips."""
    parts = (("a  stiffer tips", _STIFFER), ("b  softer tips", _SOFTER)) if f.swept else (("", _STIFFER),)
    panels = (ratio(f, name, f"${symbol}", how, *gammas, _AT) for name, gammas in parts)
    reference = "" if f.swept else f"Reference: {f.reference}, the same surface. "
    return FigureData(title, f"{reference}{f.caption}", tuple(panels))


def ratio(f: Compared, title: str, symbol: str, how: Any, line: Array, gammas: Array, at: Array) -> Panel:
    """Draw a ratio to the reference over gamma, if that is swept, else over the separation."""
    ylabel = rf"{symbol}_\mathrm{{{'hom' if f.swept else 'ref'}}}$"
    if not f.swept:
        series = tuple(
            Series(label, f.line, how.exact(f, label, f.line),
                   f.points(partial(how.drawn, f, label, f.h), how.exact(f, label, f.h)))
            for label in f.others
        )  # fmt: skip
        return Panel(title, SEPARATION, ylabel, series, level=1.0)
    mean, stderr = np.array([how.drawn(f, float(gamma), at) for gamma in gammas]).transpose(1, 2, 0)
    curves, truth = (np.array([how.exact(f, float(gamma), at) for gamma in x]).T for x in (line, gammas))
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
    shown, panels = [(name, Ratio(name, at_load=True)) for name in _SHOWN], []
    if f.swept:
        shown.insert(0, ("equal separation: stiffness (Eq. 15)", Ratio("stiffness")))
    for key, (name, how) in zip("abcd", shown, strict=False):
        symbol = quantity_of(how.name).symbol.removesuffix("ρ")  # the resistivity is that of both
        title = f"{key}  {'equal load: ' * (f.swept and how.at_load)}{name}"
        panels.append(ratio(f, title, f"${symbol}/{symbol}", how, _LINE, _GAMMAS, _AT_LOAD))
    title = "At equal load the trend reverses: stiffer tips conduct less" if f.swept else "At the same load"
    which = "homogeneous surface" if f.swept else f"reference ({f.reference}, the same surface)"
    return FigureData(title, f"d/σ is that of the {which} and sets the load. {f.caption}", tuple(panels))
