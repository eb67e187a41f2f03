"""Figures of a report inside its page, as SVG."""

import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.ensemble.at_load import pressures_of
from mcgw.ensemble.solution import solutions
from mcgw.ensemble.solved import Solution
from mcgw.figures.against_theory import quantity_panel
from mcgw.figures.data import FigureData, Panel, Points, Series
from mcgw.figures.panels import draw
from mcgw.figures.style import STYLE, write_figure
from mcgw.formats.table import Column, Table
from mcgw.scene.in_words import joint_text
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import Comparison

_MOST_SURFACES, _MOST_HEIGHTS = 2000, 3e6  # drawn at once for all pressures of a page
_FEWEST = 20
_PRESSURES = 7  # of the table and of the curves, straight where both scales are logarithmic
_BAND, _OF_BAND = 0.9, " Band: 5 to 95 % of the specimens."
_PER_AREA = (  # name, factor from SI, title, unit
    ("area", 100, "Real contact area", "%"),
    ("stiffness", 1e-12, "Normal stiffness", "MPa/µm"),
    ("contact_conductance", 1, "Contact conductance", ""),
    ("conductance", 1, "Contact conductance times ρ", "1/m"),
)
_OF_JOINT = {"gap_conductance": "Gap conductance", "joint_conductance": "Joint conductance"}


@dataclass(frozen=True)
class PageFigure:
    """A figure in a page.

    Parameters
    ----------
    label : str
        What it shows.
    svg : str
        An element that takes the width it is given.
    panel : Panel, optional
        What is drawn, where a table has it too.
    """

    label: str
    svg: str
    panel: Panel | None = None


def comparison_figures(comparison: Comparison) -> list[PageFigure]:
    """Each quantity with its theory, and how far surfaces spread."""
    found = []
    for name in comparison.ensemble.scene.answers:
        figure = draw(FigureData("", "", (quantity_panel(comparison, name),)))
        found.append(line_figure(figure, quantity_of(name).long_name))
    if comparison.ensemble.n_surfaces > 1:
        found.append(line_figure(draw(_spread(comparison)), "std over mean against separation"))
    return found


def solved_pressures(scene: Scene) -> list[Solution]:
    """Answers at pressures that the scene's separations span; none where that is not known."""
    if "load" not in scene.quantities:
        return []
    try:
        pressures = pressures_of(scene, _PRESSURES)
        most = int(_MOST_HEIGHTS / float(scene.theory.mean("contacts", scene.lowest)))
        few = replace(scene, n_surfaces=min(scene.n_surfaces, _MOST_SURFACES, max(most, _FEWEST)))
        return solutions(few, "load", (scene.surface.nominal_area * pressures).tolist())
    except ValueError:
        return []


def pressure_pictures(solved: Sequence[Solution]) -> Iterator[PageFigure]:
    """What holds at equal nominal pressure."""
    for data in pressure_curves(solved):
        (panel,) = data.panels
        low, high = panel.series[0].x[[0, -1]]
        label = f"{panel.title} against nominal pressure from {low:.3g} to {high:.3g} MPa"
        yield replace(line_figure(draw(data), label), panel=panel)


def pressure_table(figures: Sequence[PageFigure], scene: Scene) -> Table | None:
    """Their means; None where there are none."""
    panels = [figure.panel for figure in figures if figure.panel is not None]
    if not panels:
        return None
    columns = [Column("nominal pressure (MPa)", panels[0].series[0].x, form=".3g")]
    columns += [Column(panel.ylabel, panel.series[0].theory, form=".4g") for panel in panels]
    return Table(tuple(columns), f"Means; conductances: {joint_text(scene)}" if scene.thermal else "Means")


def line_figure(figure: Figure, label: str) -> PageFigure:
    """An SVG element that takes the width it is given."""
    buffer = io.StringIO()
    with mpl.rc_context(STYLE | {"svg.hashsalt": label}):
        write_figure(figure, buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    head, rest = text.split(">", 1)
    head = re.sub(r' (width|height)="[^"]*"', "", head)
    # Ids are unique in a page: each figure has its own.
    mark = re.sub(r"\W+", "-", label)
    rest = re.sub(r'(id="|href="#|url\(#)', rf"\g<1>{mark}-", rest)
    return PageFigure(label, svg=f"{head}>{rest}")


def _spread(comparison: Comparison) -> FigureData:
    ensemble = comparison.ensemble
    scene, h = ensemble.scene, ensemble.separations
    order = np.argsort(h, kind="stable")
    series = []
    for name in scene.quantities:
        curve = comparison.curves[name]
        touches = curve.theory != 0
        exact = np.full(len(h), np.nan)
        exact[touches] = (curve.stderr * np.sqrt(ensemble.n_surfaces))[touches] / np.abs(
            curve.theory[touches]
        )
        error = exact * _relative_error(scene, name) / np.sqrt(ensemble.n_surfaces)
        known = (ensemble.mean(name) > 0) & (exact > 0) & (error > 0)
        mean, std = ensemble.mean(name)[known], ensemble.std(name)[known]
        points = Points(h[known], std / mean, error[known], exact[known])
        series.append(Series(name, h[order], exact[order], points))
    panel = Panel("Spread over surfaces", "separation d/σ", "std / mean", tuple(series), ("linear", "log"))
    return FigureData("", "Lines: exact. Markers: the ensemble, with standard errors.", (panel,), columns=1)


def _relative_error(scene: Scene, name: str) -> Array:
    """Of std over mean of one surface, to first order: half of std's, that of the mean, and both together."""
    exact = scene.theory.cumulants(name, scene.separations)
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = np.sqrt(exact.variance) / np.abs(exact.mean)
        return np.asarray(np.sqrt((exact.excess_kurtosis + 2) / 4 + spread**2 - exact.skewness * spread))


def pressure_curves(solved: Sequence[Solution]) -> list[FigureData]:
    """Means over specimens at rising pressures in MPa, in the unit of the label.

    The band holds 90 % of the specimens: of the separation by its exact law, where it is quickly known.
    """
    if not solved:
        return []
    scene = solved[0].scene
    pressure = np.array([each.amount for each in solved]) / scene.surface.nominal_area / 1e6
    curves = []
    for name, factor, title, label in _asked(scene):
        mean = factor * np.array([each.value[name] for each in solved])
        low, high = factor * np.array([each.specimens(name, _BAND) for each in solved]).T
        series = Series("mean", pressure, mean, band=(low, high))
        scales = ("log", "linear" if name == "separation" else "log")
        panel = Panel(title, "nominal pressure P/Aₙ (MPa)", label, (series,), scales)
        curves.append(FigureData("", f"Line: mean.{_OF_BAND}", (panel,)))
    return curves


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
