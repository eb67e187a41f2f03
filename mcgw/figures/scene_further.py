"""What the paper lacks, of anybody's scene: equal load, area and load, spread, who yields, the way back."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.beside import SCENE, Beside, NoMeaningError, needs_pressing, needs_reference
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series
from mcgw.figures.listed import PRESSURE
from mcgw.figures.style import prefixed
from mcgw.scene.scene import Scene, SceneError

__all__ = ["area_and_load", "equal_load", "fluctuations", "way_back", "who_yields"]

Array = NDArray[np.float64]


def equal_load(b: Beside) -> FigureData:
    """Conductance, area and stiffness over the reference's, where both carry the same load."""
    needs_reference(b)
    needs_pressing(b)
    panels = []
    at, line = (_separations(b, h) for h in (b.h, b.line))
    drawn = {label: _drawn_at(b.all[label], h) for label, h in at.items()}
    for key, name, symbol in (("a", "conductance", "C"), ("b", "area", "A"), ("c", "stiffness", "K")):
        series = []
        for label, h in at.items():
            exact = b.theory(label, name, h) / b.theory(b.reference, name, b.h)
            curve = b.theory(label, name, line[label]) / b.theory(b.reference, name, b.line)
            there, here = drawn[label], b.drawn[b.reference].values(name)
            points = b.ratio(there.values(name), here, exact) if there else None
            series.append(Series(label, b.line, curve, points))
        ylabel = rf"${symbol}/{symbol}_\mathrm{{ref}}$"
        panels.append(Panel(f"{key}  {name}", SEPARATION, ylabel, tuple(series), level=1.0))
    caption = f"d/σ is that of the reference ({b.reference}, the same surface) and sets the load. {b.caption}"
    return FigureData("equal-load", "At the same load", caption, tuple(panels))


def _separations(b: Beside, h: Array) -> dict[str, Array]:
    """By label, where the same load is carried that the reference carries at these."""
    loads = b.theory(b.reference, "load", h)
    try:
        return {label: scene.theory.separation_at("load", loads) for label, scene in list(b.all.items())[:-1]}
    except ValueError:
        raise NoMeaningError(
            "the scene does not carry the load of its reference at every separation"
        ) from None


def _drawn_at(scene: Scene, h: Array) -> Ensemble | None:
    """The ensemble at other separations, if its modulus is positive down to them."""
    try:
        return simulate(scene, separations=h)
    except SceneError:
        return None


def area_and_load(b: Beside) -> FigureData:
    """Real area over pressure."""
    needs_pressing(b)
    area = b.scene.surface.nominal_area
    series = []
    for label, scene in b.all.items():
        pressure, fraction = (b.theory(label, name, b.line) / area for name in ("load", "area"))
        points = b.means(label, "area", area)
        if points:
            points = replace(points, x=b.drawn[label].mean("load")[b.enough(scene)] / area / 1e6)
        order = np.argsort(pressure)
        series.append(Series(label, pressure[order] / 1e6, fraction[order], points))
    panel = Panel("", PRESSURE, r"real area fraction $A/A_n$", tuple(series), ("log", "log"))
    return FigureData("area-and-load", "Real area against load", b.caption, (panel,), columns=1)


def who_yields(b: Beside) -> FigureData:
    """Share of the contacts that yielded."""
    if b.scene.law.elastic or not np.any(b.theory(SCENE, "yielded", b.line)):
        raise NoMeaningError(f"nothing yields under contact.law = {b.scene.law.name!r}")
    needs_pressing(b)
    area = b.scene.surface.nominal_area
    series = []
    for label, scene in b.all.items():
        if scene.law.elastic:
            continue
        ensemble = simulate(scene.replace(quantities=("load", "contacts", "yielded")))
        load = b.theory(label, "load", b.line)
        share, exact = (b.theory(label, "yielded", h) / b.theory(label, "contacts", h) for h in (b.line, b.h))
        points = b.ratio(ensemble.values("yielded"), ensemble.values("contacts"), exact)
        if points:
            points = replace(points, x=ensemble.mean("load")[b.enough(b.scene)] / area / 1e6)
        series.append(Series(label, load / area / 1e6, share, points))
    panel = Panel("", PRESSURE, "share of the contacts that yielded", tuple(series), ("log", "linear"))
    return FigureData("who-yields", "Who yields", b.caption, (panel,), columns=1)


def way_back(b: Beside) -> FigureData:
    """Load and contacts on the way in and back."""
    turn = b.asked.unload_from
    if turn is None:
        raise NoMeaningError("the scene is not released: contact.unload_from is left out")
    both = b.scene.replace(unload_from=b.asked.unload_from, quantities=("load", "contacts"))
    ensemble, area = simulate(both), both.surface.nominal_area
    most = max(np.abs(both.theory.mean(name, b.line)).max() for name in ("load", "load_unloading"))
    unit, prefix = prefixed(float(most) / area)
    labels = {"load": f"pressure ({prefix}Pa)", "contacts": "contacts per mm²"}
    panels = []
    for key, (name, ylabel) in zip("ab", labels.items(), strict=True):
        size = area * (unit if name == "load" else 1e6)
        series = []
        for way, asked in (("in", name), ("back", f"{name}_unloading")):
            line, exact = (both.theory.mean(asked, h) / size for h in (b.line, b.h))
            values = ensemble.values(asked) / size
            known = np.count_nonzero(values, axis=0) >= 20
            points = None
            if known.any():
                mean, std = values.mean(axis=0), values.std(axis=0, ddof=1)
                columns = (b.h, mean, std / np.sqrt(len(values)), exact)
                points = Points(*(x[known] for x in columns))
            series.append(Series(way, b.line, line, points))
        panels.append(Panel(f"{key}  {name}", SEPARATION, ylabel, tuple(series), level=0.0))
    title = f"Pressed to d/σ = {both.theory.unload_from:g}, and let go"
    return FigureData("way-back", title, b.caption, tuple(panels))


def fluctuations(b: Beside) -> FigureData:
    """How far surfaces differ."""
    if b.scene.n_surfaces < 2:
        raise NoMeaningError("there is one surface: nothing differs")
    known, series = b.enough(b.scene), []
    for name in ("load", "area", "stiffness"):
        line, exact = (b.scene.theory.std(name, h) / np.abs(b.theory(SCENE, name, h)) for h in (b.line, b.h))
        points = _spread(b.drawn[SCENE].values(name)[:, known], b.h[known], exact[known])
        series.append(Series(name, b.line, line, points))
    panel = Panel("", SEPARATION, "std / mean", tuple(series), ("linear", "log"), level=1.0)
    title = f"How far surfaces of {b.scene.surface.nominal_area * 1e6:g} mm² differ from each other"
    return FigureData("fluctuations", title, b.caption, (panel,), columns=1)


def _spread(x: Array, h: Array, exact: Array) -> Points | None:
    """std/mean and its standard error, by its influence function."""
    if not h.size:
        return None
    mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
    z = (x - mean) / std
    influence = std / mean * ((z**2 - 1) / 2 - z * std / mean)
    return Points(h, std / np.abs(mean), influence.std(axis=0) / np.sqrt(len(x)), exact)
