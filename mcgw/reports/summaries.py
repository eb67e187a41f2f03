"""What a file holds, in words: an ensemble, a sweep, or a sweep that is not finished."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.tables import statistics_table
from mcgw.formats.table import Table, stacked
from mcgw.reports.text import summary
from mcgw.store.run_folder import RunFolder
from mcgw.sweeps.axes import Axes

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep

__all__ = ["progress_of", "summary_of"]


def summary_of(result: "Ensemble | Sweep", attributes: dict[str, Any]) -> tuple[str, Callable[[], Table]]:
    """The summary for people, and what makes the table for programs."""
    if isinstance(result, Ensemble):
        names = result.scene.quantities
        return summary(result, attributes), lambda: stacked(
            {name: statistics_table(result, name) for name in names}, "quantity"
        )
    lines = [
        str(result),
        f"  digest  {attributes['digest']}",
        f"  made    {attributes['date']} in {attributes['wall_seconds']:.3g} s on {attributes['cpu']}",
        f"  with    {attributes['versions']}; commit {attributes['commit']}",
    ]
    return "\n".join(lines), result.table


def progress_of(run: RunFolder, path: Path) -> str:
    """How far a sweep has come."""
    axes, total = Axes.from_text(run.axes), run.plan.total
    missing = sum(span.n for span in run.missing(0, run.shards()))
    return (
        f"{path}: a sweep of {axes.size} points over {', '.join(axes.keys)}, not finished: "
        f"{total - missing} of {total} surfaces are drawn; the same mcgw sweep goes on"
    )
