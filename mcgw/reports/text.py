"""Ensembles, sweeps and comparisons with theory as plain text."""

from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import statistics_table
from mcgw.formats.law_text import law_text
from mcgw.formats.table import SEPARATION, Column, Table, stacked
from mcgw.machine.terminal import listed, one_line
from mcgw.scene.writing import accuracy_facts, contact_facts
from mcgw.statistics.comparison import Comparison, SweepComparison
from mcgw.store.run_plan import Plan
from mcgw.sweeps.axes import Axes

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep

_KEPT = "statistics alone: mean, covariance, skewness, quantiles, extremes"
_SHOWN = ("separation", "mean", "std", "stderr")
_COLUMNS = 6  # quantities that stand in one table
_LISTED, _WORST = 12, 3  # points of a sweep; rows that are farthest from theory


def summary(result: "Ensemble | Sweep", attributes: dict[str, Any], full: bool = True) -> str:
    """Tell what a file holds: provenance and a table of means; if `full`, one a quantity with its spread."""
    origin = [
        ("digest", str(attributes["digest"])),
        ("made", f"{attributes['date']} in {attributes['wall_seconds']:.2f} s on {attributes['cpu']}"),
        ("with", f"{attributes['versions']}; commit {attributes['commit']}"),
    ]
    if not isinstance(result, Ensemble):
        return "\n".join([str(result), *listed(origin)])
    scene, n = result.scene, result.n_surfaces
    h, total = scene.separations, scene.n_surfaces
    so_far, spent = "" if n == total else f" so far, of {total},", attributes.get("accuracy_spent")
    of_it = "" if spent is None else f", {spent:.2g} of it spent"
    facts = [
        ("surfaces", f"{n}{so_far} of {scene.n_asperities} asperities each ({scene.count})"),
        ("separations", f"{len(h)} from {min(h):g} to {max(h):g} (d/sigma)"),
        ("grading", law_text(scene.grading)),
        *contact_facts(scene),
        ("sampler", f"{result.sampler}, seed {scene.seed}"),
        *((word, f"{what}{of_it}") for word, what in accuracy_facts(scene)),
        *([] if scene.keep != "statistics" else [("kept", _KEPT)]),
        ("complete", "yes" if attributes["complete"] else "no"),
        *origin,
    ]
    lines = [one_line(scene.title) or "ensemble", *listed(facts, 12)]
    lines += [f"  {line}" for line in scene.validity().lines]
    if full:
        for name in scene.answers:
            lines += ["", statistics_table(result, name).only(*_SHOWN).rows().text()]
        return "\n".join(lines)
    columns = [Column("separation", result.separations, SEPARATION, form="g")]
    for x in scene.answers[:_COLUMNS]:  # to the digits that their standard errors allow
        unit, error = scene.quantity(x).unit, result.stderr(x)
        columns.append(Column(x, result.mean(x), x.replace("_", " "), unit, error=error))
    means = Table(tuple(columns)).rows().text()
    return "\n".join([*lines, "", means, "standard deviations, all quantities: add -v"])


def comparison_text(comparison: Comparison) -> str:
    """Monte Carlo beside theory at some separations."""
    scene = comparison.ensemble.scene
    facts = [f"{word}: {what}" for word, what in (*contact_facts(scene), *accuracy_facts(scene))]
    return "\n".join([*facts, *(table.rows().text() for table in comparison.tables().values())])


def ratios_in_words(sweep: "Sweep") -> list[str]:
    """Of each quantity a line: its mean at the last point over that at the first, on the same surfaces."""
    h, axes = sweep.separations, sweep.axes
    ends = dict.fromkeys((int(np.argmin(h)), int(np.argmax(h))))
    last, first = axes.text(axes.size - 1), axes.text(0)
    lines = []
    for name, pairs in sweep.ratios().items():
        ratio, (low, high) = pairs[-1].ratio, pairs[-1].interval()
        found = (f"{ratio[k]:.5g} ({low[k]:.5g} to {high[k]:.5g}) at d/sigma = {h[k]:g}" for k in ends)
        lines.append(f"{quantity_of(name).long_name}, {last} over {first}: {', '.join(found)}")
    return lines


def comparison_summary(comparison: Comparison | SweepComparison, *, whole: bool) -> tuple[str, list[str]]:
    """Return the table, whole or its worst rows, as text; and the verdict."""
    lines = [comparison.verdict.line]
    if not isinstance(comparison, Comparison):
        return comparison.sheet(_LISTED if whole else _WORST).text(), lines
    lines.append(comparison.ensemble.scene.validity().verdict)
    if comparison.of_many:
        lines.append(f"tables and figure {comparison.of_many}; the verdict is on all of them")
    return comparison_text(comparison) if whole else comparison.worst(_WORST).text(), lines


def table_of(result: "Ensemble | Sweep") -> Table:
    """Return means, standard deviations and standard errors of all that a file holds."""
    if not isinstance(result, Ensemble):
        return result.table()
    return stacked({name: statistics_table(result, name) for name in result.scene.answers}, "quantity")


def progress_of(plan: Plan) -> str:
    """How far a sweep has come."""
    axes, total = Axes.from_text(plan.axes), plan.total
    missing = sum(span.n for span in plan.missing(0, plan.shards()))
    return (
        f"{plan.path}: a sweep of {axes.size} points over {', '.join(axes.keys)}, not finished: "
        f"{total - missing} of {total} surfaces are drawn; run mcgw sweep again to resume"
    )
