"""The figures of `mcgw figures`: one row each, of the paper's preset swept over gamma or of any scene."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from functools import partial
from importlib.resources import files

import numpy as np

from analytic import Hertz, quantity_of
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import SCENE, Compared, Mean, Modulus, over_separation, ratio
from mcgw.figures.panels import GAMMA, PRESSURE, SEPARATION, FigureData, Panel, Series
from mcgw.figures.studies import spread, spread_panel
from mcgw.figures.style import power_of_ten, prefixed
from mcgw.machine.process import steps
from mcgw.scene.scene_file import scene_from

_SPREADING = ("load", "area", "stiffness")
_BESIDE = 1.5  # sigma above the highest separation that a grading is shown
_AT, _AT_LOAD = np.arange(5.0), np.array([1.0, 2.0, 3.0])  # separations of the paper's ratios
_STIFFER = np.linspace(1, 2, 81), np.array([1.2, 1.4, 1.6, 1.8, 2.0])  # gammas of lines and of points
_SOFTER = np.linspace(0.2, 1, 81), np.array([0.2, 0.4, 0.6, 0.8])
_MODULI = np.linspace(0.2, 2, 73), np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 1.6, 1.8, 2.0])
_LOADED = np.linspace(0.2, 2, 46), np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.5, 2.0])
_PSI = r"$\psi/\psi_\mathrm{hom}$"
_WEIGHTS = {"number": "mean over the contacts", "area": "weighted by area", "load": "weighted by load"}
_GRADES = ("γ = 2", "γ = 1", "γ = 0.5", "γ = 0.2")


def gradings(f: Compared) -> FigureData:
    """Show the modulus over the height."""
    s = f.line if f.swept else np.linspace(f.h.min(), f.h.max() + _BESIDE, 161)
    panels = []
    for title, labels in f.groups if f.swept else (("", (SCENE, "homogeneous")),):
        series = tuple(Series(label, s, f.all[label].modulus(s)) for label in labels)
        panels.append(Panel(title, "summit height s = z/σ", "E*(s)/E*", series))
    if f.swept:
        caption = "E*(s)/E* = γ − (γ − 1) exp(−s). Theory alone."
        return FigureData("Exponential grading (Eq. 4)", caption, tuple(panels))
    return FigureData("The grading", f.caption(0), tuple(panels))


def against_separation(f: Compared, *, title: str, quantity: str, words: str, unit: str) -> FigureData:
    """Show means: of a sweep as the paper's integrals, else per nominal area."""
    q, area = quantity_of(quantity), f.scene.surface.nominal_area
    if f.swept:
        size = f.scene.n_asperities * q.scale(f.scene.surface)
        ylabel = rf"{quantity} integral $F^*_{{{2 * q.exponent:g}/2}}$"
    else:
        top = max(float(np.abs(f.theory(label, quantity, f.line)).max()) for label in f.all)
        factor, prefix = prefixed(top / area)
        size, ylabel = area * factor, f"{words} ${q.symbol}/A_n$ ({prefix}{unit})"
    panels = []
    for name, labels in f.groups:
        series = tuple(over_separation(f, label, Mean((quantity,), factor=1 / size)) for label in labels)
        panels.append(Panel(name, SEPARATION, ylabel, series, ("linear", "log")))
    return FigureData(title, f.caption(), tuple(panels))


def at_separation(f: Compared, *, title: str, symbol: str, how: Mean) -> FigureData:
    """Show a ratio; of a sweep a panel for stiffer and one for softer tips."""
    parts = (("a  stiffer tips", _STIFFER), ("b  softer tips", _SOFTER)) if f.swept else (("", _STIFFER),)
    panels = (ratio(f, name, symbol, how, gammas, _AT) for name, gammas in parts)
    said = "" if f.swept else f"Reference: {f.reference}, the same surface. "
    return FigureData(title, said + f.caption(), tuple(panels))


def equal_load(f: Compared) -> FigureData:
    """Show conductance, area and stiffness over the reference's, where both carry the same load."""
    names = ("conductance", "area", "stiffness")
    shown = [(f"{'equal load: ' * f.swept}{name}", Mean((name,), (), True, True)) for name in names]
    if f.swept:
        shown.insert(0, ("equal separation: stiffness (Eq. 15)", Mean(("stiffness",), relative=True)))
    panels = []
    for key, (name, how) in zip("abcd", shown, strict=False):
        symbol = quantity_of(*how.above).symbol.removesuffix("ρ")  # the resistivity is that of both
        panels.append(ratio(f, f"{key}  {name}", f"{symbol}/{symbol}", how, _LOADED, _AT_LOAD))
    title = "At equal load the trend reverses: stiffer tips conduct less" if f.swept else "At the same load"
    which = "homogeneous surface" if f.swept else f"reference ({f.reference}, the same surface)"
    return FigureData(title, f"d/σ is that of the {which} and sets the load. {f.caption()}", tuple(panels))


def area_and_load(f: Compared) -> FigureData:
    """Show the real area over the pressure; of a sweep the local exponent, too."""
    area, areas = f.scene.surface.nominal_area, []
    for label in _GRADES if f.swept else f.all:
        one = over_separation(f, label, Mean(("area",), factor=1 / area))
        if points := one.points:
            points = replace(points, x=f.values(label, "load", points.x).mean(axis=0) / area / 1e6)
        areas.append(replace(one, x=f.theory(label, "load", f.line) / area / 1e6, points=points))
    panel = Panel("", PRESSURE, r"real area fraction $A/A_n$", tuple(areas), ("log", "log"))
    if not f.swept:
        return FigureData("Real area against load", f.caption(), (panel,))
    # (n/A)/(K/P), to the slope by dA/dd = -pi R n and dP/dd = -K
    factor = np.pi * f.scene.surface.radius
    exponent = Mean(("contacts", "load"), ("area", "stiffness"), factor=factor)
    exponents = tuple(over_separation(f, label, exponent) for label in _GRADES)
    local = Panel("b  local exponent", SEPARATION, r"$d\,\ln A/d\,\ln P$", exponents, level=1.0)
    panels = replace(panel, title="a  real area"), local
    return FigureData("Real area against load, and its local exponent", f.caption(), panels)


def mean_moduli(f: Compared) -> FigureData:
    """Show the mean modulus of the contacts, which the plasticity index goes as."""
    title, caption = "Plasticity index over that of the homogeneous surface", f.caption(len(f.listed))
    if f.swept:
        gamma, _ = _MODULI
        just = tuple(Series(f"d/σ = {h:g}", gamma, gamma - (gamma - 1) * np.exp(-h)) for h in _AT)
        panels = [Panel("a  as in the paper: just touching, s = d/σ", GAMMA, _PSI, just, level=1.0)]
        for key, (weight, words) in zip("bcd", _WEIGHTS.items(), strict=True):
            panels.append(ratio(f, f"{key}  {words}", r"\psi/\psi", Modulus(weight), _MODULI, _AT))
        return FigureData(title, caption, tuple(panels))
    weights, said = {"contacts": "number"}, "Mean over the contacts, each weighted alike (contacts)"
    if type(f.scene.law) is Hertz and f.scene.summits is None:  # else neither is a power of the overlap
        weights, said = weights | {"area": "area", "load": "load"}, f"{said}, by its area, or by its load"
    listed = len(f.listed) or 1  # surfaces: points where these are enough
    series = (over_separation(f, label, Modulus(w), SCENE, listed) for label, w in weights.items())
    panel = Panel("", SEPARATION, _PSI, tuple(series), level=1.0)
    return FigureData(title, f"{said}. {caption}", (panel,))


def fluctuations(f: Compared) -> FigureData:
    """Show the standard deviation over the mean: of a sweep from a hundred asperities to a million."""
    if not f.swept:
        panel = replace(spread_panel("", f.drawn(SCENE, f.h), f.line, _SPREADING), level=1.0)
        area = f.scene.surface.nominal_area * 1e6
        return FigureData(f"Scatter of surfaces of {area:g} mm²", f.caption(), (panel,))
    scene = f.scene.replace(keep="sums", separations=np.linspace(0, 4, 9), quantities=_SPREADING)
    scenes = {n: scene.replace(n_asperities=n) for n in (100, 1000, 10_000, 100_000, 1_000_000)}
    sizes = (100, 10_000, 1_000_000)
    drawn = {n: simulate(scenes[n], n_surfaces=min(2000, 400_000_000 // n)) for n in sizes}
    line, panels = np.linspace(0, 4, 41), []
    for key, name in zip("abc", scene.quantities, strict=True):
        labelled = ((f"N = {power_of_ten(n)}", one, drawn.get(n)) for n, one in scenes.items())
        series = tuple(spread(label, one, name, line, seen, 400) for label, one, seen in labelled)
        panels.append(Panel(f"{key}  {name}", SEPARATION, "std / mean", series, ("linear", "log"), 1.0))
    number = f"2000 surfaces (400 for N = 10⁶), seed {scene.seed}"
    caption = f"N asperities per surface; {number}. Markers with 95 % intervals, for 400 contacts or more."
    return FigureData("Scatter of finite surfaces", caption, tuple(panels))


CATALOGUE: dict[str, tuple[Callable[..., FigureData], tuple[str, ...]]] = {  # needs: see `_lacking`
    "figure-1": (gradings, ("grading",)),
    "figure-2": (partial(against_separation, quantity="load", words="pressure", unit="Pa",
                         title="Load at a given separation (Eq. 7)"), ()),
    "figure-3": (partial(at_separation, title="Area per load at a given separation (Eq. 12)",
                         symbol=r"(A/P)\,/\,(A/P)", how=Mean(("area",), ("load",), relative=True)),
                 ("reference", "pressing")),
    "figure-4": (mean_moduli, ("grading",)),
    "figure-5": (partial(against_separation, quantity="stiffness", words="stiffness", unit="Pa/m",
                         title="Stiffness at a given separation; the paper's “conductance”"), ()),
    "figure-6": (partial(at_separation, title="Stiffness at a given separation (Eq. 15: “conductance”)",
                         symbol="K/K", how=Mean(("stiffness",), relative=True)), ("reference",)),
    "area-and-load": (area_and_load, ("pressing",)),
    "equal-load": (equal_load, ("reference", "pressing", "same load")),
    "fluctuations": (fluctuations, ("several",)),
}  # fmt: skip


def of_paper() -> Compared:
    """Take the surfaces of the preset ``demo``, in the paper's reduced quantities."""
    text = (files("mcgw.scene") / "presets" / "demo.toml").read_text(encoding="utf-8")
    return Compared(scene_from(text).replace(n_surfaces=2000), swept=True)  # of the paper's figures


def _lacking(f: Compared, need: str) -> str:
    """Say what a scene lacks that a figure needs, or nothing."""
    match need:
        case "grading" if not f.graded:
            return "the scene has no grading: E*(s) = E* at every height"
        case "reference" if not f.others:
            return "the scene is its own reference (homogeneous, Hertz's law): every ratio is 1"
        case "pressing" if any(np.any(f.theory(label, "load", f.line) <= 0) for label in f.all):
            return "the mean load is not positive at every separation"
        case "several" if f.scene.n_surfaces == 1:
            return "there is only one surface"
        case "same load":
            try:
                for label in f.others:
                    f.at_load_of_reference(label, f.line)
            except ValueError:
                return "the scene does not reach the load of its reference at every separation"
    return ""


def figures_of(f: Compared, only: Collection[str] = ()) -> Iterator[tuple[str, FigureData | str]]:
    """Yield name and numbers of all figures, or `only` of some; or why one has no meaning for a scene."""
    for name in steps([name for name in CATALOGUE if not only or name in only], "figures"):
        draw, needs = CATALOGUE[name]
        why = next((why for need in needs if (why := _lacking(f, need))), "")
        yield name, why or draw(f)
