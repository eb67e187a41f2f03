"""The tables of a report, as texts: means beside theory, one for each quantity."""

from dataclasses import dataclass

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.formats.evenly import evenly
from mcgw.reports.numbers import columns
from mcgw.scene.validity import Validity
from mcgw.statistics.comparison import Comparison

__all__ = ["ReportTable", "errors_table", "means_table", "quantity_table"]

_MOST_ROWS = 9


@dataclass(frozen=True)
class ReportTable:
    """A table under a heading; its numbers all have one format."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def quantity_table(comparison: Comparison, name: str) -> ReportTable:
    """A quantity at some separations: mean, half of its 95 % interval, theory, residual."""
    curve, h = comparison.curves[name], comparison.ensemble.separations
    k = evenly(len(h), _MOST_ROWS)
    half = (curve.high - curve.low)[k] / 2
    mean, errors, theory = columns([(curve.mean[k], 5), (half, 2), (curve.theory[k], 5)])
    told = [text or TOO_FEW for text in errors]
    residuals = [f"{x:+.1f}".replace("-", "−") for x in curve.residual[k]]
    rows = zip([f"{x:g}" for x in h[k]], mean, told, theory, residuals, strict=True)
    return ReportTable(_title(name), ("d/σ", "mean", "± 95 %", "theory", "residual"), tuple(rows))


def means_table(ensemble: Ensemble, name: str) -> ReportTable:
    """The same of surfaces that have means only."""
    h = ensemble.separations
    k = evenly(len(h), _MOST_ROWS)
    mean, theory = columns([(ensemble.mean(name)[k], 5), (ensemble.scene.theory.mean(name, h[k]), 5)])
    return ReportTable(
        _title(name),
        ("d/σ", "mean", "theory"),
        tuple(zip([f"{x:g}" for x in h[k]], mean, theory, strict=True)),
    )


def errors_table(found: Validity) -> ReportTable:
    """How far the model is from elasticity at some separations; no rows where that was not measured."""
    sheet = found.sheet()
    if not sheet.rows:
        return ReportTable("", (), ())
    (pressures,) = columns([(np.array([float(row[1]) for row in sheet.rows]), 2)])
    rows = (
        (row[0], p, *(x.replace("-", "−") for x in row[2:]))
        for row, p in zip(sheet.rows, pressures, strict=True)
    )
    return ReportTable("", tuple(sheet.header), tuple(rows))


def _title(name: str) -> str:
    q = quantity_of(name)
    words = q.name.replace("_si", "").replace("_", " ").capitalize()
    return f"{words} ({q.unit.replace('^2', '²')})" if q.unit != "1" else words
