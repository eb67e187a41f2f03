"""Studies of Monte Carlo and theory: ``mcgw compare``, ``mcgw converge`` and ``mcgw tradeoff``."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import SceneIn, Table, file_in, file_out, quantity
from mcgw.commands.outputs import ALL, FIGURE, TABLE_OR_FIGURE, details, news, says, tell_cautions

_TRADED = "{}-tradeoff.csv", "{}-tradeoff-measured.csv", "{}-tradeoff.png"


def compare(
    file: Annotated[Path, file_in("FILE", "file of an ensemble or of a sweep (HDF5)")],
    *,
    output: Annotated[Path, file_out(FIGURE, "{}.png")],
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
    from mcgw.figures.panels import save
    from mcgw.figures.studies import comparison_figure
    from mcgw.reports.text import comparison_summary
    from mcgw.statistics.comparison import compare as compared
    from mcgw.store.ensembles import open_results

    results = open_results(file)
    found = compared(results, laws=laws)
    save(comparison_figure(found), output)
    text, verdict = comparison_summary(found, whole=table or says(ALL))
    news(*verdict, f"{output}: figure")
    if csv:
        found.table().write(csv)
        news(f"{csv}: the table")
    news(f"next: mcgw report {file}", text)
    tell_cautions(results, f"mcgw show {file}")
    return found.verdict.agrees


def converge(
    scene: SceneIn,
    *,
    output: Annotated[list[Path], file_out(TABLE_OR_FIGURE, "out", names=("{}-converge.png",))],
) -> bool:
    """Test statistical convergence: slopes, coverage, variance, skewness, ... (exit code 1 if it fails).

    Parameters
    ----------
    output : DIR
        folder of the figure

    Examples
    --------
    mcgw converge runs/demo.toml -o out
    """
    from mcgw.figures.panels import save
    from mcgw.figures.studies import convergence_figure
    from mcgw.statistics.convergence import SEEDS, converge as tested

    found = tested(scene)
    save(convergence_figure(found), output[0])
    many = f"{SEEDS} ensembles of {found.scene.n_surfaces} surfaces"
    news(f"convergence {found.word}: p = {found.p:.3g} over all checks of {many}", f"{output[0]}: figure")
    if says(ALL) or not found.passed:
        news(found.table().text())
    return found.passed


def tradeoff(
    scene: SceneIn,
    *,
    output: Annotated[list[Path], file_out(TABLE_OR_FIGURE, "out", names=_TRADED)],
    seconds: Annotated[float, quantity("s")] = 60.0,
) -> None:
    """Measure what each answer costs, how exact it is, and recommend a way.

    Parameters
    ----------
    output : DIR
        folder of tables and figure
    seconds : TIME
        time limit, s, or with a unit, such as "5 min"

    Examples
    --------
    mcgw tradeoff runs/demo.toml -o out
    """
    from mcgw.figures.panels import save
    from mcgw.figures.studies import tradeoff_figure
    from mcgw.statistics.tradeoff import tradeoff as studied
    from mcgw.statistics.ways import TARGETS

    table, measured, figure = output
    found = studied(scene, seconds=seconds)
    found.table().write(table)
    found.measurements().write(measured)
    save(tradeoff_figure(found), figure)
    news(found.sheet(TARGETS).text())
    news(f"{table}: what to run for each error ({found.seconds:.0f} s)", f"{figure}: figure")
    details("", found.measurements().text())
