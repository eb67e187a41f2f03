"""``mcgw report``: an ensemble as one HTML page."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import EnsembleIn, file_out, values
from mcgw.commands.outputs import HTML, source
from mcgw.commands.voice import news


def report(
    file: EnsembleIn,
    *,
    output: Annotated[Path, file_out(HTML, "{}.html")],
    pressures: Annotated[list[float] | None, values("Pa")] = None,
) -> None:
    """Write a report: one HTML page with figures, tables, verdict and provenance.

    Parameters
    ----------
    output : HTML
        the page
    pressures : P
        nominal pressures of the answers: kPa, MPa, GPa; default: round ones that the separations span

    Examples
    --------
    mcgw report demo.h5 -o demo.html
    """
    from mcgw.formats.files import write_whole
    from mcgw.reports.html import report_html
    from mcgw.store.ensembles import read_attributes

    page = report_html(file, read_attributes(source()), pressures)
    write_whole(output, [page.encode()])
    news(f"{output}: report, {len(page.encode()) / 1e6:.2f} MB; open it in a browser")
