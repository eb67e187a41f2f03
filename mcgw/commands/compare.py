"""``mcgw compare``: Monte Carlo against theory."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import EnsembleOrSweep, Table, file_out
from mcgw.commands.outputs import figure_format, source
from mcgw.commands.voice import ALL, news, says


def compare(
    file: EnsembleOrSweep,
    *,
    output: Annotated[Path, file_out(figure_format, "{}.png")],
    csv: Table = None,
    table: bool = False,
    laws: bool = False,
) -> bool:
    """Compare an ensemble or a sweep with theory: verdict and figure (exit code 1 if they disagree).

    Parameters
    ----------
    output : PNG
        figure (.png, .pdf, .svg, ...)
    csv : FILE
        also write the table, of at most 100 separations
    table
        print all means beside theory, not only the worst three
    laws
        also test the values of single surfaces against their exact distribution

    Examples
    --------
    mcgw compare demo.h5 -o demo.png
    """
    from mcgw.figures.against_theory import comparison_figure
    from mcgw.figures.panels import save
    from mcgw.reports.text import comparison_summary
    from mcgw.statistics.comparison import compare as compared

    found = compared(file, laws=laws)
    save(comparison_figure(found), output)
    text, verdict = comparison_summary(found, whole=table or says(ALL))
    news(*verdict, f"{output}: figure")
    if csv:
        found.table().write(csv)
        news(f"{csv}: the table")
    news(f"next: mcgw report {source()}", text)
    return found.verdict.agrees
