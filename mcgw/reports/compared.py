"""What is said of a comparison with theory, of an ensemble or of all points of a sweep."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from mcgw.formats.table import Table, stacked
from mcgw.reports.elasticity import against_elasticity
from mcgw.reports.text import comparison_text, verdict_line
from mcgw.statistics.comparison import Comparison

if TYPE_CHECKING:
    from mcgw.statistics.sweep_comparison import SweepComparison

__all__ = ["told"]

_LISTED = 12  # points


def told(comparison: "Comparison | SweepComparison") -> tuple[str, Callable[[], Table], list[str]]:
    """The table for people, what makes that for programs, and the lines of the verdict."""
    if not isinstance(comparison, Comparison):
        return comparison.sheet_of(_LISTED).text(), comparison.table, [comparison.verdict.line]
    known = against_elasticity(comparison.ensemble.scene.validity())
    lines = [verdict_line(comparison.verdict), *known]
    return comparison_text(comparison), lambda: stacked(comparison.tables(), "quantity"), lines
