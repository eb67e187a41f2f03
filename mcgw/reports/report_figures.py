"""Figures of a report inside its page, as SVG."""

import io
import re
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import matplotlib as mpl
import numpy as np

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.ensemble.at_load import answers_at, pressures_of, quantities_at
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import laws_are_quick
from mcgw.ensemble.solution import solutions
from mcgw.ensemble.solved import Solution
from mcgw.figures.against_theory import quantity_panel, spread
from mcgw.figures.data import SEPARATION, FigureData, Panel, Series
from mcgw.figures.panels import draw
from mcgw.figures.style import SEEN, STYLE
from mcgw.formats.table import evenly
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import Comparison

_FEW_HEIGHTS, _FEWEST = 3e6, 20  # drawn at once for all pressures of a page, where they are drawn
_PRESSURES = 7  # of the table and of the curves, at most
_ROUND = (1.0, 2.0, 5.0)
_FINE = 49  # points of a curve
_PER_AREA = (  # name, factor from SI, title, unit
    ("area", 100, "Real contact area", "%"),
    ("stiffness", 1e-12, "Normal stiffness", "MPa/µm"),
    ("contact_conductance", 1, "Contact conductance", ""),
    ("conductance", 1, "Contact conductance times ρ", "1/m"),
)
_OF_JOINT = {"gap_conductance": "Gap conductance", "joint_conductance": "Joint conductance"}


def comparison_pictures(comparison: Comparison) -> dict[str, str]:
    """Draw each quantity with its theory, and how far surfaces spread: SVG elements by what they show."""
    ensemble = comparison.ensemble
    names = ensemble.scene.answers
    panels = {quantity_of(name).long_name: quantity_panel(comparison, name) for name in names}
    if ensemble.n_surfaces > 1:
        panels["std over mean against separation"] = spread_panel(ensemble)
    return {label: svg_of(panel, label) for label, panel in panels.items()}


def solved_pressures(scene: Scene, pressures: Sequence[float] | None = None) -> list[Solution]:
    """Answers at pressures, Pa; by default at round ones that the scene's separations span, if any are."""
    if "load" not in scene.quantities:
        return []
    try:
        low, high = pressures_of(scene, 2).tolist()
        asked = round_pressures(low, high, _PRESSURES) if pressures is None else pressures
        if not laws_are_quick(scene):  # specimens are drawn, their contacts one by one
            most = int(_FEW_HEIGHTS / float(scene.theory.mean("contacts", scene.lowest)))
            scene = scene.replace(n_surfaces=min(scene.n_surfaces, max(most, _FEWEST)))
        return solutions(scene, "load", [scene.surface.nominal_area * pressure for pressure in asked])
    except ValueError:
        if pressures is None:
            return []
        raise


def round_pressures(low: float, high: float, most: int) -> list[float]:
    """At most so many pressures 1, 2 and 5 times a power of ten between two; these if there is none."""
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    found = [float(f"{x:g}e{k}") for k in powers for x in _ROUND if low <= float(f"{x:g}e{k}") <= high]
    return [found[k] for k in evenly(len(found), most)] if found else [low, high]


def pressure_pictures(solved: Sequence[Solution]) -> dict[str, str]:
    """Draw what holds at equal nominal pressure: SVG elements by what they show."""
    pictures = {}
    for panel in pressure_curves(solved):
        low, *_, high = panel.series[0].x
        label = f"{panel.title} against nominal pressure from {low:.3g} to {high:.3g} MPa"
        pictures[label] = svg_of(panel, label)
    return pictures


def svg_of(panel: Panel, label: str) -> str:
    """Draw a panel as an SVG element that takes the width it is given; its ids begin with the label."""
    buffer, figure = io.StringIO(), draw(FigureData("", "", (panel,)))
    with mpl.rc_context(STYLE | {"svg.hashsalt": label}):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    head, rest = text.split(">", 1)
    head = re.sub(r' (width|height)="[^"]*"', "", head)
    mark = re.sub(r"\W+", "-", label)
    rest = re.sub(r'(id="|href="#|url\(#)', rf"\g<1>{mark}-", rest)
    return f"{head}>{rest}"


def spread_panel(ensemble: Ensemble) -> Panel:
    """Show how far surfaces spread."""
    scene, line = ensemble.scene, np.sort(ensemble.separations)
    series = tuple(spread(name, scene, name, line, ensemble) for name in scene.quantities)
    return Panel("Spread over surfaces", SEPARATION, "std / mean", series, ("linear", "log"))


def pressure_curves(solved: Sequence[Solution]) -> list[Panel]:
    """Means over specimens at rising pressures, MPa, with their scatter, on those of an infinite surface."""
    if not solved:
        return []
    scene, area = solved[0].scene, solved[0].scene.surface.nominal_area
    alone, ends = scene.alone, [each.theory["separation"] for each in solved]
    h = np.linspace(max(ends), min(ends), _FINE)
    sums = {name: np.asarray(alone.mean(name, h)) for name in quantities_at(scene)}
    line = answers_at(scene, {"separation": h, **sums})
    pressure = np.array([each.amount for each in solved]) / area / 1e6
    curves = []
    for name, factor, title, label in _asked(scene):
        mean, std = (
            factor * np.array([x[name] for x in some])
            for some in ([each.value for each in solved], [each.std for each in solved])
        )
        dots = partial(_draw_specimens, pressure, mean, std)
        series = Series("infinite surface", sums["load"] / area / 1e6, factor * np.asarray(line[name]))
        scales = ("log", "linear" if name == "separation" else "log")
        curves.append(Panel(title, "nominal pressure P/Aₙ (MPa)", label, (series,), scales, paint=dots))
    return curves


def _draw_specimens(pressure: Array, mean: Array, std: Array, axis: Any) -> None:
    axis.errorbar(pressure, mean, std, **SEEN, fmt="o", label="specimens: mean, std")


def _asked(scene: Scene) -> Iterator[tuple[str, float, str, str]]:
    """Name, factor from SI, title and label of the answers to the scene's quantities."""
    area = scene.surface.nominal_area
    held = {"contact_conductance" if name == "conductance_si" else name for name in scene.quantities}
    conducted = scene.quantity("contact_conductance").unit.replace("^2", "²")
    yield "separation", 1.0, "Load: pressure at a separation", "separation d/σ"
    for name, factor, title, unit in _PER_AREA:
        if name in held and not (name == "conductance" and "contact_conductance" in held):
            per = 1.0 if name == "contact_conductance" else area
            symbol = quantity_of("conductance_si" if name == "contact_conductance" else name).symbol
            yield name, factor / per, title, f"{symbol}/Aₙ ({unit or conducted})"
    for name in filter(_OF_JOINT.__contains__, scene.of_joint):
        yield name, 1.0, _OF_JOINT[name], f"{quantity_of(name).symbol} ({conducted})"
