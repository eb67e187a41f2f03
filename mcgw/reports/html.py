"""Report of an ensemble: one HTML page without network or scripts, its figures inside as SVG."""

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
from mcgw.ensemble.ensemble import Ensemble, how_many
from mcgw.ensemble.intervals import laws_are_quick
from mcgw.ensemble.solution import solutions
from mcgw.ensemble.solved import Solution
from mcgw.figures.panels import FigureData, Panel, Series, draw
from mcgw.figures.studies import quantity_panel, spread_panel
from mcgw.figures.style import SEEN, STYLE, grading_label
from mcgw.formats.table import Column, Table, evenly, typeset
from mcgw.machine.process import told
from mcgw.machine.terminal import one_line, plain_text
from mcgw.reports.text import answer_table, by_load
from mcgw.scene.cautions import cautions, other_laws
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import compare

_PROVENANCE = ("digest", "seed", "sampler", "date", "versions", "commit", "cpu")
_FEW_HEIGHTS, _FEWEST = 3e6, 20  # drawn at once for all pressures of a page, where they are drawn
_PRESSURES = 7  # of the table and of the curves, at most
_LIST = re.compile(r"\[\n([^\]]*)\]")  # of the scene as TOML, each shown on one line


def report_html(
    ensemble: Ensemble, attributes: dict[str, Any], pressures: Sequence[float] | None = None
) -> str:
    """Make the page of an ensemble from it and the attributes of its file: scene, digest, versions, ...

    Answers are at some pressures, Pa; by default at round ones that its separations span. The template
    extends ``page.html.j2``, which sets its look on screens and in print; every text is escaped.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined  # only pages need it

    scene = ensemble.scene
    page = Environment(
        loader=PackageLoader("mcgw.reports", "."), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    page.filters["typeset"] = typeset
    with told(None, "steps") as tell:
        tell(0, 3)
        comparison = compare(ensemble)
        tell(1, 3)
        solved = solved_pressures(scene, pressures)
        at_pressure = {label: svg_of(panel, label) for label, panel in pressure_panels(solved)}
        tell(2, 3)
        panels = {quantity_of(x).long_name: quantity_panel(comparison, x) for x in comparison.curves}
        if ensemble.n_surfaces > 1:
            line = np.sort(ensemble.separations)
            panels["std over mean against separation"] = spread_panel("Spread over surfaces", ensemble, line)
        figures = {label: svg_of(panel, label) for label, panel in panels.items()}
        tell(3, 3)
    text = _LIST.sub(lambda found: f"[{' '.join(found[1].split()).rstrip(',')}]", attributes["scene"])
    return page.get_template("report.html.j2").render(
        title=one_line(scene.title) or "Ensemble of rough surfaces",
        ensemble=ensemble,
        grading=grading_label(scene.grading),
        shown=how_many(ensemble),
        comparison=comparison,
        at_pressure=at_pressure,
        by_pressure=by_load(scene, solved) if solved else None,
        solved=solved[len(solved) // 2] if solved else None,
        answers=answer_table(solved[len(solved) // 2]) if solved else None,
        figures=figures,
        facts=_surface_facts(scene),
        laws=_laws_table(scene),
        against=scene.validity(),
        cautions=cautions(scene),
        elastic_law=scene.law.elastic,
        provenance=[(key, str(({"seed": scene.seed} | attributes)[key])) for key in _PROVENANCE],
        scene=plain_text(text),
    )


def _surface_facts(scene: Scene) -> list[tuple[str, str]]:
    """Tell what the scene is, and its parameters in units of sigma."""
    x = scene.surface
    area, radius, overlap = x.nominal_area / x.sigma**2, x.radius / x.sigma, x.eta * x.radius * x.sigma
    contacts = float(scene.theory.mean("contacts", scene.lowest))
    return [
        *scene.sheet().facts,
        ("reduced", f"R/σ = {radius:.4g}, ηRσ = {overlap:.4g}, Aₙ/σ² = {area:.4g}"),
        ("contacts", f"{contacts:.4g} expected at the smallest separation"),
    ]


def _laws_table(scene: Scene) -> Table | None:
    """Other contact laws beside that of a scene, at the same material; None if nothing yields."""
    if (others := other_laws(scene)) is None:
        return None
    words = (
        f"Means at d/σ = {others.separation:g} by theory, over those of this report, for the same critical "
        f"penetration of {others.critical:.4g} σ. The choice between elastic-plastic laws changes the load "
        f"by up to {others.worth:.0%}."
    )
    names = Column("law", [f"{scene.law.name} (this one)", *others.load], "contact law")
    load, area = ([1.0, *ratios.values()] for ratios in (others.load, others.area))
    return Table((names, Column("load", load, form=".4g"), Column("area", area, form=".4g")), words)


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
    found = [x for k in powers for each in (1, 2, 5) if low <= (x := float(f"{each}e{k}")) <= high]
    return [found[k] for k in evenly(len(found), most)] if found else [low, high]


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


def pressure_panels(solved: Sequence[Solution]) -> Iterator[tuple[str, Panel]]:
    """Show what holds at rising pressures, MPa: means over specimens, on those of an infinite surface."""
    if not solved:
        return
    scene, area = solved[0].scene, solved[0].scene.surface.nominal_area
    alone, ends = scene.alone, [each.theory["separation"] for each in solved]
    h = np.linspace(max(ends), min(ends), 49)  # points of a curve
    sums = {name: np.asarray(alone.mean(name, h)) for name in quantities_at(scene)}
    line = answers_at(scene, {"separation": h, **sums})
    pressure = np.array([each.amount for each in solved]) / area / 1e6
    x = np.clip(sums["load"] / area / 1e6, pressure.min(), pressure.max())  # one is one in all digits
    span = f"from {x[0]:.3g} to {x[-1]:.3g} MPa"
    for name, factor, title, label in _asked(scene):
        mean, std = factor * np.array([(each.value[name], each.std[name]) for each in solved]).T
        series = Series("infinite surface", x, factor * np.asarray(line[name]))
        scales = ("log", "linear" if name == "separation" else "log")
        dots = partial(_draw_specimens, pressure, mean, std)
        panel = Panel(title, "nominal pressure P/Aₙ (MPa)", label, (series,), scales, paint=dots)
        yield f"{title} against nominal pressure {span}", panel


def _draw_specimens(pressure: Array, mean: Array, std: Array, axis: Any) -> None:
    axis.errorbar(pressure, mean, std, **SEEN, fmt="o", label="specimens: mean, std")


def _asked(scene: Scene) -> Iterator[tuple[str, float, str, str]]:
    """Name, factor from SI, title and label of the answers to the scene's quantities."""
    area, asked = scene.surface.nominal_area, scene.quantities
    conducted = scene.quantity("contact_conductance").unit.replace("^2", "²")
    yield "separation", 1.0, "Load: pressure at a separation", "separation d/σ"
    if "area" in asked:
        yield "area", 100 / area, "Real contact area", "A/Aₙ (%)"
    if "stiffness" in asked:
        yield "stiffness", 1e-12 / area, "Normal stiffness", "K/Aₙ (MPa/µm)"
    if "conductance_si" in asked:
        yield "contact_conductance", 1.0, "Contact conductance", f"C/Aₙ ({conducted})"
    elif "conductance" in asked:
        yield "conductance", 1 / area, "Contact conductance times ρ", "Cρ/Aₙ (1/m)"
    if "gap_conductance" in scene.of_joint:
        yield "gap_conductance", 1.0, "Gap conductance", f"h_g ({conducted})"
    if "joint_conductance" in scene.of_joint:
        yield "joint_conductance", 1.0, "Joint conductance", f"h_j ({conducted})"
