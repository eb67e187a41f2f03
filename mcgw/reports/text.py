"""Ensembles and comparisons as plain text."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import interval_text
from mcgw.ensemble.over_surfaces import PROBABILITIES
from mcgw.ensemble.paired import Paired, paired_ratio
from mcgw.formats.csv_table import Row
from mcgw.formats.evenly import evenly
from mcgw.machine.terminal import one_line
from mcgw.reports.elasticity import two_questions
from mcgw.scene.contact_text import accuracy_facts, contact_facts
from mcgw.scene.law_text import law_text
from mcgw.statistics.comparison import FALSE_ALARM, Comparison, Verdict

__all__ = [
    "COMPARISON_HEADER",
    "RATIO_HEADER",
    "comparison_rows",
    "comparison_table",
    "ratio_rows",
    "ratio_table",
    "summary",
    "summary_header",
    "summary_rows",
    "verdict_line",
]

COMPARISON_HEADER = (
    "quantity",
    "unit",
    "separation",
    "mean",
    "low_95",
    "high_95",
    "std",
    "theory",
    "residual",
)
_SUMMARY_HEADER = ("quantity", "unit", "separation", "mean", "std", "stderr")
RATIO_HEADER = ("quantity", "separation", "ratio", "stderr", "theory", "variance_gain")
_MOST_ROWS = 9
_KEPT = "  kept          statistics alone: mean, covariance, skewness, quantiles, extremes"
_WITH_STATISTICS = ("skewness", *(f"quantile_{share:g}" for share in PROBABILITIES))


def summary(ensemble: Ensemble, attributes: dict[str, Any]) -> str:
    """What a file holds: provenance and a table of means."""
    scene = ensemble.scene
    lines = [
        one_line(scene.title) or "ensemble",
        f"  surfaces      {_so_far(ensemble)} of {scene.n_asperities} asperities each ({scene.count})",
        f"  separations   {len(scene.separations)} from {min(scene.separations):g} to "
        f"{max(scene.separations):g} (d/sigma)",
        f"  grading       {law_text(scene.grading)}",
        *(f"  {word:13} {what}" for word, what in contact_facts(scene)),
        f"  sampler       {ensemble.sampler}, seed {scene.seed}",
        *(f"  {word:13} {what}{_spent(word, attributes)}" for word, what in accuracy_facts(scene)),
        *([] if scene.keep != "statistics" else [_KEPT]),
        f"  complete      {'yes' if attributes['complete'] else 'no'}",
        f"  digest        {attributes['digest']}",
        f"  made          {attributes['date']} in {attributes['wall_seconds']:.2f} s on {attributes['cpu']}",
        f"  with          {attributes['versions']}; commit {attributes['commit']}",
        *(f"  {line}" for line in two_questions(scene.validity())),
    ]
    for name in scene.quantities:
        mean, std, stderr = ensemble.mean(name), ensemble.std(name), ensemble.stderr(name)
        q = quantity_of(name)
        lines += [
            "",
            f"{q.long_name} ({q.unit})",
            f"  {'d/sigma':>8} {'mean':>13} {'std':>11} {'stderr':>11}",
        ]
        for k in evenly(len(ensemble.separations), _MOST_ROWS):
            lines.append(f"  {scene.separations[k]:8.3f} {mean[k]:13.6g} {std[k]:11.3g} {stderr[k]:11.3g}")
    return "\n".join(lines)


def _so_far(ensemble: Ensemble) -> str:
    """How many surfaces there are, and of how many while the run goes on."""
    n, total = ensemble.n_surfaces, ensemble.scene.n_surfaces
    return f"{n}" if n == total else f"{n} so far, not yet {total},"


def _spent(word: str, attributes: dict[str, Any]) -> str:
    """How much of what was allowed was spent."""
    spent = attributes.get(f"{word}_spent")
    return "" if spent is None else f", {spent:.2g} of it spent"


def comparison_table(comparison: Comparison) -> str:
    """Monte Carlo beside theory at some separations."""
    h = comparison.ensemble.separations
    scene = comparison.ensemble.scene
    lines = [f"{word}: {what}" for word, what in (*contact_facts(scene), *accuracy_facts(scene))]
    for name, curve in comparison.curves.items():
        q = quantity_of(name)
        lines += [
            f"{q.long_name} ({q.unit})",
            f"  {'d/sigma':>8} {'Monte Carlo':>13} {'95 % interval':>27} {'theory':>13} {'residual':>9}",
        ]
        for k in evenly(len(h), _MOST_ROWS):
            interval = interval_text(curve.low[k], curve.high[k])
            lines.append(
                f"  {h[k]:8.3f} {curve.mean[k]:13.6g} {interval:>27} {curve.theory[k]:13.6g} "
                f"{curve.residual[k]:+9.2f}"
            )
    return "\n".join(lines)


def comparison_rows(comparison: Comparison) -> Iterator[Row]:
    """Every separation, as rows under `COMPARISON_HEADER`; an interval of too few contacts is nan."""
    ensemble = comparison.ensemble
    for name, c in comparison.curves.items():
        columns = (ensemble.separations, c.mean, c.low, c.high, ensemble.std(name), c.theory, c.residual)
        for row in zip(*columns, strict=True):
            yield name, quantity_of(name).unit, *row


def summary_header(ensemble: Ensemble) -> tuple[str, ...]:
    """Names of the columns of `summary_rows`: more where statistics are all there is."""
    return (*_SUMMARY_HEADER, *(_WITH_STATISTICS if ensemble.scene.keep == "statistics" else ()))


def summary_rows(ensemble: Ensemble) -> Iterator[Row]:
    """Every separation, as rows under `summary_header`."""
    for name in ensemble.scene.quantities:
        columns = [ensemble.separations, ensemble.mean(name), ensemble.std(name), ensemble.stderr(name)]
        if ensemble.scene.keep == "statistics":
            quantiles = [ensemble.quantile(name, share) for share in PROBABILITIES]
            columns += [ensemble.skewness(name), *quantiles]
        for row in zip(*columns, strict=True):
            yield name, quantity_of(name).unit, *row


def _ratios(new: Ensemble, old: Ensemble) -> Iterator[tuple[str, Paired, np.ndarray]]:
    """Name, ratio by Monte Carlo and by theory of each quantity that the change enters."""
    other_law = new.scene.law != old.scene.law
    for name in filter(old.scene.quantities.__contains__, new.scene.quantities):
        q = quantity_of(name)
        if q.modulus or (other_law and not q.counts):
            exact, before = (e.scene.theory.mean(name, e.separations) for e in (new, old))
            with np.errstate(invalid="ignore", divide="ignore"):
                yield name, paired_ratio(new, old, name), exact / before


def ratio_rows(new: Ensemble, old: Ensemble) -> Iterator[Row]:
    """Every separation, as rows under `RATIO_HEADER`."""
    for name, pair, exact in _ratios(new, old):
        for row in zip(new.separations, pair.ratio, pair.stderr, exact, pair.gain, strict=True):
            yield name, *row


def ratio_table(new: Ensemble, old: Ensemble) -> str:
    """Ratios of means over the same surfaces, beside theory: Eqs. (12) and (15)."""
    lines = []
    for name, pair, exact in _ratios(new, old):
        lines += [
            f"{quantity_of(name).long_name}, new over old",
            f"  {'d/sigma':>8} {'ratio':>10} {'stderr':>9} {'theory':>10}   variance, independent/paired",
        ]
        for k in evenly(len(new.separations), _MOST_ROWS):
            lines.append(
                f"  {new.scene.separations[k]:8.3f} {pair.ratio[k]:10.6g} {pair.stderr[k]:9.1e} "
                f"{exact[k]:10.6g}   {pair.gain[k]:.3g}"
            )
    return "\n".join(lines)


def verdict_line(verdict: Verdict) -> str:
    """One line: do they agree, and how sure is that."""
    word = "agree" if verdict.agrees else "DISAGREE"
    return (
        f"Monte Carlo and theory of this model {word}: {verdict.seen}, p = {verdict.p:.3g} (false alarms: "
        f"1 in {1 / FALSE_ALARM:.0f})"
    )
