"""A report of an ensemble: one HTML page that needs no network and no script."""

import re
from typing import Any

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.tables import statistics_table
from mcgw.formats.numbers import typeset
from mcgw.formats.table import Column, Table
from mcgw.machine.progress import stages
from mcgw.machine.terminal import one_line, plain_text
from mcgw.reports.elasticity import elasticity_words
from mcgw.reports.laws_section import laws_table
from mcgw.reports.report_facts import opening_words, provenance_facts, surface_facts
from mcgw.reports.report_figures import (
    comparison_figures,
    means_figures,
    patch_pictures,
    pressure_pictures,
)
from mcgw.reports.text import verdict_line
from mcgw.scene.cautions import cautions
from mcgw.scene.samplers import promise_of
from mcgw.statistics.comparison import Comparison, compare

__all__ = ["rendered", "report_html"]

_MOST_ROWS = 9


def report_html(ensemble: Ensemble, attributes: dict[str, Any]) -> str:
    """The page of an ensemble and of the attributes of its file: scene, digest, versions, ...

    Surfaces that have means only have no test against theory, and no band.
    """
    scene, against = ensemble.scene, ensemble.scene.validity()
    real = promise_of(ensemble.sampler).real_surfaces
    with stages(4) as done:
        comparison = compare(ensemble) if real else None
        done()
        at_pressure = list(pressure_pictures(ensemble))
        done()
        patch = patch_pictures(ensemble)
        done()
        figures = means_figures(ensemble) if comparison is None else comparison_figures(comparison)
        tables = _means(ensemble) if comparison is None else list(comparison.tables().values())
        done()
    return rendered(
        "report.html.j2",
        title=one_line(scene.title) or "Ensemble of rough surfaces",
        words=opening_words(ensemble),
        agrees=comparison is None or comparison.verdict.agrees,
        verdict=_verdict(ensemble, comparison),
        elastic=against.verdict,
        at_pressure=at_pressure,
        several=real and ensemble.n_surfaces > 1,
        patch=patch,
        figures=figures,
        tables=[table.rows(_MOST_ROWS) for table in tables],
        tested=comparison is not None,
        facts=surface_facts(ensemble),
        laws=laws_table(scene),
        elasticity=elasticity_words(against),
        errors=against.sheet().table,
        cautions=cautions(scene),
        elastic_law=scene.law.elastic,
        provenance=provenance_facts(attributes, scene.seed),
        scene=plain_text(_shorter(attributes["scene"])),
    )


def rendered(template: str, **values: Any) -> str:
    """A page of a template of this folder; every text in it is escaped.

    Pages extend ``page.html.j2``, which has their look, on screens of any width and in print.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined  # for who asks for a page

    environment = Environment(
        loader=PackageLoader("mcgw.reports", "."), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    environment.filters["typeset"] = typeset
    return environment.get_template(template).render(**values)


def _means(ensemble: Ensemble) -> list[Table]:
    """Means and theory of surfaces whose fluctuations are no real ones."""
    found, h = [], ensemble.separations
    for name in ensemble.scene.quantities:
        table, unit = statistics_table(ensemble, name), quantity_of(name).unit
        theory = Column("theory", ensemble.scene.theory.mean(name, h), unit=unit)
        found.append(Table((*table.only("separation", "mean").columns, theory), table.title))
    return found


def _verdict(ensemble: Ensemble, comparison: Comparison | None) -> str:
    if comparison is not None:
        return verdict_line(comparison.verdict)
    return f"These are {ensemble.sampler} surfaces: their means serve, nothing tests them against theory"


def _shorter(scene: str) -> str:
    """The scene with each list of numbers or names on one line: the same TOML."""
    return re.sub(r"\[\n[^\]]*\]", _one_line, scene)


def _one_line(listed: re.Match[str]) -> str:
    return f"[{' '.join(listed.group()[1:-1].split()).rstrip(',')}]"
