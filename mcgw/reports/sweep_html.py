"""A report of a sweep: one HTML page, with the same look as that of an ensemble."""

from typing import Any

from mcgw.figures.sweep_comparison import sweep_figure
from mcgw.machine.progress import Progress
from mcgw.machine.terminal import one_line, plain_text
from mcgw.reports.html import rendered
from mcgw.reports.report_facts import provenance_facts
from mcgw.reports.report_figures import line_figure
from mcgw.statistics.sweep_comparison import compare_sweep
from mcgw.sweeps.cautions import sweep_cautions
from mcgw.sweeps.sweep import Sweep

__all__ = ["sweep_report_html"]

_LISTED = 12  # points


def sweep_report_html(sweep: Sweep, attributes: dict[str, Any], *, progress: Progress = None) -> str:
    """The page of a sweep and of the attributes of its file: scene, digest, ..."""
    comparison = compare_sweep(sweep, progress=progress)
    verdict = comparison.verdict
    first = sweep.scenes[0]
    return rendered(
        "sweep.html.j2",
        title=one_line(first.title) or "Sweep of scenes",
        agrees=verdict.agrees,
        verdict=verdict.line,
        words=_words(sweep),
        figure=line_figure(sweep_figure(comparison), "residuals of all points, and of the worst one"),
        table=comparison.sheet_of(_LISTED).table,
        cautions=sweep_cautions(sweep),
        axes=[(key, sweep.axes.summary(key)) for key in sweep.axes.keys],
        provenance=provenance_facts({**attributes, "sampler": first.sampler}, first.seed),
        scene=plain_text(attributes["scene"]),
    )


def _words(sweep: Sweep) -> str:
    h = sweep.separations
    return (
        f"{sweep.axes.size} scenes at {len(h)} separations from d/σ = {h.min():g} to {h.max():g}; "
        f"{sum(group.n for group in sweep.groups)} surfaces were drawn, in {len(sweep.groups)} groups whose "
        "points share theirs."
    )
