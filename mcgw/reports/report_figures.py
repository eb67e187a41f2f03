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
from mcgw.ensemble.at_load import at_pressures, common_pressures, with_values
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import exact_ends
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.against_theory import quantity_panel
from mcgw.figures.data import FigureData, Panel, Points, Series
from mcgw.figures.panels import draw
from mcgw.figures.style import STYLE, write_figure
from mcgw.formats.table import Column, Table, evenly
from mcgw.scene.in_words import joint_text
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import Comparison

MOST_SURFACES = 2000  # that mean and band are of: more would move them by less than a line is wide
_POINTS = 60
_BAND, _OF_BAND = (0.05, 0.95), " Band: 5 to 95 % of the surfaces."
_PER_AREA = (  # name, factor from SI, title, unit
    ("area", 100, "Real contact area", "%"),
    ("stiffness", 1e-12, "Normal stiffness", "MPa/µm"),
    ("conductance_si", 1, "Contact conductance", ""),
    ("conductance", 1, "Contact conductance times ρ", "1/m"),
)
_OF_JOINT = {"gap_conductance": "Gap conductance", "joint_conductance": "Joint conductance"}
_ROWS = 6  # of the table of all of them


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


def pressure_pictures(ensemble: Ensemble) -> Iterator[PageFigure]:
    """What holds at equal nominal pressure."""
    for data in pressure_curves(ensemble):
        (panel,) = data.panels
        low, high = panel.series[0].x[[0, -1]]
        label = f"{panel.title} against nominal pressure from {low:.3g} to {high:.3g} MPa"
        yield replace(line_figure(draw(data), label), panel=panel)


def pressure_table(figures: Sequence[PageFigure], scene: Scene) -> Table | None:
    """Their means at some pressures; None where there are none."""
    panels = [figure.panel for figure in figures if figure.panel is not None]
    if not panels:
        return None
    x = panels[0].series[0].x
    rows = evenly(len(x), _ROWS)
    columns = [Column("nominal pressure (MPa)", x[rows], form=".3g")]
    columns += [Column(panel.ylabel, panel.series[0].theory[rows], form=".4g") for panel in panels]
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


def pressure_curves(ensemble: Ensemble) -> list[FigureData]:
    """Of what an ensemble holds, each surface read off at the pressure; empty without a common one.

    Mean over the surfaces, in the unit of the label, over rising pressures in MPa; the band holds 90 % of the
    surfaces, if there are several: of the separation by its exact law, where it is known.
    """
    if "load" not in ensemble.scene.quantities:
        return []
    first = first_surfaces(ensemble)
    reach = common_pressures(first)
    if reach is None:
        return []
    pressure = np.geomspace(*reach, _POINTS)
    pressure[[0, -1]] = reach  # to the last bit: beyond them there is nothing
    asked = list(_asked(ensemble))
    found = at_pressures(first, pressure, tuple(name for name, *_ in asked))
    banded = first.n_surfaces > 1
    curves = []
    for name, factor, title, label in asked:
        values = factor * found[name]
        if np.isnan(values).any():
            continue
        exact = _exact(first, pressure) if banded and name == "separation" else None
        low, high = np.quantile(values, _BAND, axis=0) if exact is None else exact
        band = (low, high) if banded else None
        series = Series("mean", pressure / 1e6, values.mean(axis=0), band=band)
        scales = ("log", "linear" if name == "separation" else "log")
        panel = Panel(title, "nominal pressure P/Aₙ (MPa)", label, (series,), scales)
        curves.append(FigureData("", f"Line: mean.{_OF_BAND * banded}", (panel,)))
    return curves


def _exact(ensemble: Ensemble, pressure: Array) -> Array | None:
    """Ends of the band of separations: the separation rises above one where the load there falls short."""
    ends = exact_ends(ensemble.scene, "load", _BAND[1] - _BAND[0])
    if ends is None:
        return None
    two = Ensemble(ensemble.scene, ensemble.sampler, MemoryResults({"load": ends}))
    found = at_pressures(two, pressure, ("separation",))["separation"]
    return None if np.isnan(found).any() else found


def first_surfaces(ensemble: Ensemble) -> Ensemble:
    """The first surfaces, in memory, with the quantities shown over pressure."""
    ensemble = with_values(ensemble, MOST_SURFACES)
    names = {name for name, *_ in _asked(ensemble)} - {"separation"} | {"load"}
    names |= {"conductance"} & {
        *ensemble.scene.quantities
    }  # of a solution, also where it is shown in SI units
    rows = {name: ensemble.sums.read(name, 0, min(MOST_SURFACES, ensemble.n_surfaces)) for name in names}
    return Ensemble(ensemble.scene, ensemble.sampler, MemoryResults(rows))


def _asked(ensemble: Ensemble) -> Iterator[tuple[str, float, str, str]]:
    """Name, factor from SI, title and label of what there is."""
    scene = ensemble.scene
    per_area, held = 1 / scene.surface.nominal_area, scene.quantities
    conducted = scene.quantity("contact_conductance").unit.replace("^2", "²")
    yield "separation", 1.0, "Load: pressure at a separation", "separation d/σ"
    for name, factor, title, unit in _PER_AREA:
        if name in held and not (name == "conductance" and "conductance_si" in held):
            yield name, factor * per_area, title, f"{quantity_of(name).symbol}/Aₙ ({unit or conducted})"
    for name in filter(_OF_JOINT.__contains__, scene.of_joint):
        yield name, 1.0, _OF_JOINT[name], f"{quantity_of(name).symbol} ({conducted})"
