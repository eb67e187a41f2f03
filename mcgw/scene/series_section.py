"""The keys of ``[grading] law = "series"``: what the grading of a Python script has become in a file."""

import sys
from typing import Any

from analytic import PiecewiseSeries
from mcgw.scene.section import Section

__all__ = ["read_series", "series_table"]


def read_series(section: Section) -> PiecewiseSeries | None:
    """Read the Chebyshev series of a grading; mistakes are noted in the section, and give None."""
    before, name = len(section.problems), section.text("name", "")
    edges, rows, kinks = (section.take(key) for key in ("edges", "coefficients", "kinks"))
    for key, value, right in (
        ("edges", edges, _are_numbers(edges)),
        ("coefficients", rows, isinstance(rows, list) and all(map(_are_numbers, rows))),
        ("kinks", kinks, kinks is None or _are_numbers(kinks)),
    ):
        if not right:
            section.fail(key, value, f"give a list of {'lists of ' * (key == 'coefficients')}finite numbers")
    if len(section.problems) > before:
        return None
    try:
        return PiecewiseSeries(edges, rows, name, kinks or ())
    except ValueError as error:
        key, _, advice = str(error).partition(": ")
        section.fail(key, {"edges": edges, "coefficients": rows, "kinks": kinks}[key], advice)
        return None


def _are_numbers(value: Any) -> bool:
    """Whether it is a list of finite numbers."""
    return isinstance(value, list) and all(
        isinstance(x, int | float) and not isinstance(x, bool) and abs(x) <= sys.float_info.max for x in value
    )


def series_table(series: PiecewiseSeries) -> dict[str, Any]:
    """The table [grading] of series, read again the same."""
    return {
        "law": "series",
        "name": series.name,
        "edges": list(series.edges),
        "coefficients": [list(row) for row in series.coefficients],
        "kinks": list(series.kinks),
    }
