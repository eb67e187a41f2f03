"""Report of an ensemble: one HTML page without network or scripts."""

import re
from collections.abc import Sequence
from typing import Any

from mcgw.ensemble.ensemble import Ensemble, how_many
from mcgw.figures.style import grading_label
from mcgw.formats.numbers import typeset
from mcgw.formats.table import Column, Table
from mcgw.machine.progress import told
from mcgw.machine.terminal import one_line, plain_text
from mcgw.reports.report_figures import comparison_pictures, pressure_pictures, solved_pressures
from mcgw.reports.solved_loads import answer_table, by_load
from mcgw.scene.cautions import cautions
from mcgw.scene.law_cautions import other_laws
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import compare

_PROVENANCE = ("digest", "seed", "sampler", "date", "versions", "commit", "cpu")
_LIST = re.compile(r"\[\n([^\]]*)\]")  # of the scene as TOML, each shown on one line


def report_html(
    ensemble: Ensemble, attributes: dict[str, Any], pressures: Sequence[float] | None = None
) -> str:
    """Make the page of an ensemble from it and the attributes of its file: scene, digest, versions, ...

    Answers are at some pressures, Pa; by default at round ones that its separations span.
    """
    scene = ensemble.scene
    with told(None, "steps") as tell:
        tell(0, 3)
        comparison = compare(ensemble)
        tell(1, 3)
        at_loads = solved_pressures(scene, pressures)
        at_pressure = pressure_pictures(at_loads)
        tell(2, 3)
        figures = comparison_pictures(comparison)
        tables = list(comparison.tables().values())
        tell(3, 3)
    return rendered(
        "report.html.j2",
        title=one_line(scene.title) or "Ensemble of rough surfaces",
        words=opening_words(ensemble),
        verdict=comparison.verdict,
        at_pressure=at_pressure,
        by_pressure=by_load(scene, at_loads) if at_loads else None,
        solved=at_loads[len(at_loads) // 2] if at_loads else None,
        answer_table=answer_table,
        figures=figures,
        tables=[table.rows() for table in tables],
        facts=surface_facts(ensemble),
        laws=laws_table(scene),
        against=scene.validity(),
        cautions=cautions(scene),
        elastic_law=scene.law.elastic,
        provenance=[(key, str(({"seed": scene.seed} | attributes)[key])) for key in _PROVENANCE],
        scene=plain_text(
            _LIST.sub(lambda found: f"[{' '.join(found[1].split()).rstrip(',')}]", attributes["scene"])
        ),
    )


def rendered(template: str, **values: Any) -> str:
    """Render a template of this folder; every text is escaped.

    The page extends ``page.html.j2``, which sets its look on screens and in print.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined  # only pages need it

    environment = Environment(
        loader=PackageLoader("mcgw.reports", "."), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    environment.filters["typeset"] = typeset
    return environment.get_template(template).render(**values)


def opening_words(ensemble: Ensemble) -> str:
    """Describe what was drawn, in two sentences."""
    scene = ensemble.scene
    count = "" if scene.count == "fixed" else " on average (a Poisson number)"
    separations = f"{len(scene.separations)} separation{'s' * (len(scene.separations) > 1)}"
    return (
        f"{ensemble.n_surfaces} rough surfaces of {scene.n_asperities:g} asperities{count}, "
        f"{grading_label(scene.grading)}, each pressed on a plane at {separations} from d/σ = "
        f"{min(scene.separations):g} to {max(scene.separations):g}."
        + (f" Tables and figures are {how_many(ensemble)}." if how_many(ensemble) else "")
    )


def surface_facts(ensemble: Ensemble) -> list[tuple[str, str]]:
    """Tell what the scene is, and its parameters in units of sigma."""
    scene, x = ensemble.scene, ensemble.scene.surface
    area, radius = x.nominal_area / x.sigma**2, x.radius / x.sigma
    overlap, contacts = x.eta * x.radius * x.sigma, float(scene.theory.mean("contacts", scene.lowest))
    return [
        *scene.sheet().facts,
        ("reduced", f"R/σ = {radius:.4g}, ηRσ = {overlap:.4g}, Aₙ/σ² = {area:.4g}"),
        ("contacts", f"{contacts:.4g} expected at the smallest separation"),
    ]


def laws_table(scene: Scene) -> Table | None:
    """Other contact laws beside that of a scene, at the same material; None if nothing yields."""
    others = other_laws(scene)
    if others is None:
        return None
    names = [f"{scene.law.name} (this one)", *others.load]
    words = (
        f"Means at d/σ = {others.separation:g} by theory, over those of this report, for the same critical "
        f"penetration of {others.critical:.4g} σ. The choice between elastic-plastic laws changes the load "
        f"by up to {others.worth:.0%}."
    )
    load, area = ([1.0, *(each[name] for name in others.load)] for each in (others.load, others.area))
    numbers = (Column(name, x, unit="1", form=".4g") for name, x in (("load", load), ("area", area)))
    return Table((Column("law", names, "contact law"), *numbers), words)
