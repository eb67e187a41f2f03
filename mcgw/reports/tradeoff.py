"""A study of error against time as rows of a table."""

from collections.abc import Iterator

from mcgw.formats.csv_table import Row
from mcgw.statistics.tradeoff import Tradeoff

__all__ = ["tradeoff_header", "tradeoff_rows"]


def tradeoff_header(found: Tradeoff) -> list[str]:
    """Names of the columns: one of errors for each separation."""
    errors = [f"rms_relative_error_at_h_{h:g}" for h in found.separations]
    ends = ["rms_uncertainty", "cpu_s", "wall_s", "peak_growth_bytes", "seeds"]
    return ["method", "size", "size_counts", *errors, *ends]


def tradeoff_rows(found: Tradeoff) -> Iterator[Row]:
    """Every point, as rows under `tradeoff_header`."""
    for p in found.points:
        yield [p.method, p.size, p.unit, *p.rms, p.rms_stderr, p.cpu, p.wall, p.peak, p.seeds]
