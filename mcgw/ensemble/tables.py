"""The statistics of an ensemble as tables."""

from typing import Any

from analytic import quantity_of
from mcgw.ensemble.results import PROBABILITIES
from mcgw.formats.table import SEPARATION, Column, Table

__all__ = ["heading", "statistics_table"]


def heading(quantity: str) -> str:
    """Long name and unit of a quantity, over its table."""
    q = quantity_of(quantity)
    return q.long_name if q.unit == "1" else f"{q.long_name} ({q.unit})"


def statistics_table(ensemble: Any, name: str) -> Table:
    """Of a quantity at every separation: mean, std, stderr; and where values are not kept, what else is."""
    unit = quantity_of(name).unit
    found = [("mean", ensemble.mean(name), ".6g"), ("std", ensemble.std(name), ".3g")]
    found.append(("stderr", ensemble.stderr(name), ".3g"))
    columns = [Column(kind, values, unit=unit, form=form) for kind, values, form in found]
    if ensemble.scene.keep == "statistics":
        columns.append(Column("skewness", ensemble.skewness(name), form=".3g"))
        quantiles = ((f"quantile_{share:g}", ensemble.quantile(name, share)) for share in PROBABILITIES)
        columns += [Column(kind, values, unit=unit) for kind, values in quantiles]
    separation = Column("separation", ensemble.separations, SEPARATION, form="g")
    return Table((separation, *columns), heading(name))
