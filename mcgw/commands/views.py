"""Views of results: ``mcgw compare``, ``converge``, ``tradeoff``, ``report``, ``figures`` and ``export``."""

from pathlib import Path
from typing import Annotated, Literal

from mcgw.commands.kinds import MaybeScene, SceneIn, SceneOrFile, Table, file_in, file_out, quantity, values
from mcgw.commands.outputs import ALL, Output, check_outputs, details, news, says, tell_cautions

_TRADED = "{}-tradeoff.csv", "{}-tradeoff-measured.csv", "{}-tradeoff.png"


def compare(
    file: Annotated[Path, file_in("FILE", "file of an ensemble or of a sweep (HDF5)")],
    *,
    output: Annotated[Path, file_out("a figure", "{}.png")],
    csv: Table = None,
    laws: bool = False,
) -> bool:
    """Compare an ensemble or a sweep with theory: verdict and figure (exit code 1 if they disagree).

    output (PNG): figure (.png, .pdf, .svg, ...)
    csv (FILE): also write the table, of at most 100 separations
    laws: also test the values of single surfaces against their exact distribution

    example: mcgw compare demo.h5 -o demo.png
    """
    from mcgw.figures.panels import save
    from mcgw.figures.studies import comparison_figure
    from mcgw.reports.text import comparison_text
    from mcgw.statistics.comparison import Comparison, compare as compared
    from mcgw.store.ensembles import open_results

    results = open_results(file)
    found = compared(results, laws=laws)
    save(comparison_figure(found), output)
    news(found.sheet().text(whole=True), f"{output}: figure")
    if csv:
        found.table().write(csv)
        news(f"{csv}: the table")
    if isinstance(found, Comparison):
        details(comparison_text(found))
    news(f"next: mcgw report {file}")
    tell_cautions(results, f"mcgw show {file}")
    return found.verdict.agrees


def converge(
    scene: SceneIn,
    *,
    output: Annotated[list[Path], file_out("a figure or its table", "out", names=("{}-converge.png",))],
) -> bool:
    """Test statistical convergence: slopes, coverage, variance, skewness, ... (exit code 1 if it fails).

    output (DIR): folder of the figure

    example: mcgw converge runs/demo.toml -o out
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
    output: Annotated[list[Path], file_out("a figure or its table", "out", names=_TRADED)],
    seconds: Annotated[float, quantity("s")] = 60.0,
) -> None:
    """Measure what each answer costs, how exact it is, and recommend a way.

    output (DIR): folder of tables and figure
    seconds (TIME): time limit, s, or with a unit, such as "5 min"

    example: mcgw tradeoff runs/demo.toml -o out
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


def report(
    file: Annotated[Path, file_in("FILE", "file of an ensemble (HDF5)")],
    *,
    output: Annotated[Path, file_out("a web page", "{}.html")],
    pressures: Annotated[list[float] | None, values("Pa")] = None,
) -> None:
    """Write a report: one HTML page with figures, tables, verdict and provenance.

    output (HTML): the page
    pressures (P): nominal pressures of the answers: kPa, MPa, GPa; default: round ones that the separations
        span

    example: mcgw report demo.h5 -o demo.html
    """
    from mcgw.formats.files import write_whole
    from mcgw.reports.html import report_html
    from mcgw.store.ensembles import open_ensemble, read_attributes

    ensemble = open_ensemble(file)
    page = report_html(ensemble, read_attributes(file), pressures)
    write_whole(output, page.encode())
    news(f"{output}: report, {len(page.encode()) / 1e6:.2f} MB; open it in a browser")
    tell_cautions(ensemble, f"mcgw show {file}")


def figures(
    *,
    output: Path = Path("figures"),
    scene: MaybeScene = None,
    only: list[str] | None = None,
    format: list[str] | None = None,  # noqa: A002
    list: bool = False,  # noqa: A002
    csv: bool = False,
) -> None:
    """Draw Figures 1-6 of the paper with Monte-Carlo points, and some more; or the figures of a scene.

    output (DIR): folder
    scene (SCENE): draw this scene beside its homogeneous reference instead
    only (NAME): only these figures; default: all that apply
    format (FORMAT): png, pdf, svg, ...; default: png
    list: print the names of all figures without drawing
    csv: also write the numbers of each figure

    example: mcgw figures --scene mine.toml --only figure-2 equal-load -o figures
    """
    from mcgw.figures.catalogue import CATALOGUE, figures_of, of_paper
    from mcgw.figures.compared import Compared
    from mcgw.figures.panels import save
    from mcgw.formats.files import together

    names = [*CATALOGUE]
    if list:
        return print(*names, sep="\n")
    for name in only or ():
        if name not in names:
            raise ValueError(f"--only {name}: no such figure; give one of {', '.join(names)}")
    formats = [given.lower().removeprefix(".") for given in format or ["png"]]
    files = {
        name: [output / f"{name}.{ending}" for ending in (*formats, *["csv"] * csv)] for name in only or names
    }
    check_outputs(Output(path, "a figure or its table") for paths in files.values() for path in paths)
    drawn: tuple[Path, ...] = ()
    with together():
        for name, data in figures_of(of_paper() if scene is None else Compared(scene), only or names):
            if isinstance(data, str):
                (news if only else details)(f"{name}: not drawn: {data}")
                continue
            save(data, *files[name])
            drawn += tuple(files[name])
    details(*drawn)
    where = f"{output / '*'}.{formats[0]}" if len(formats) == 1 else output
    number = len({path.stem for path in drawn})
    return news(f"{where}: {number} figure{'s' * (number != 1)}; mcgw figures --list for their names")


def export(
    source: SceneOrFile,
    *,
    to: Literal["calculix", "abaqus", "moose", "comsol", "json"],
    table: Literal[
        "pressure-gap", "conductance-pressure", "conductance-gap", "stiffness-pressure"
    ] = "pressure-gap",
    points: int = 40,
    pressures: Annotated[list[float] | None, values("Pa")] = None,
    quantile: list[float] | None = None,
    units: Literal["SI", "mm-N-s"] = "SI",
    output: Path,
) -> None:
    """Write pressure, conductance or stiffness as a table for a finite-element program.

    source (SCENE_OR_FILE): scene (TOML), whose surfaces are drawn as needed; or an ensemble file (HDF5)
    to: the program; json: one file with all columns against the gap in SI units, and their origin
    table: the quantity and its argument
    points (N): number of rows
    pressures (P): nominal pressures, such as 10kPa:20MPa:30; default: those that the separations of the scene
        span
    quantile (Q): quantiles over the surfaces, besides the mean; default: 0.05 and 0.95
    units: units of the files
    output (FILE): file of the mean: .inp, for moose .csv, for comsol .txt, for json .json; quantiles and a
        joint table go beside it

    example: mcgw export mine.toml --to calculix --units mm-N-s -o contact.inp
    """
    from mcgw.exports.programs import PROGRAMS
    from mcgw.exports.writing import export as exported, files_of_export

    *tables, together = files_of_export(output, quantile)
    if to == "json":
        check_outputs([Output(output, "a table", endings=(".json",))])
    else:
        ours = (Output(path, f"a table for {to}", endings=PROGRAMS[to].endings) for path in tables)
        check_outputs([*ours, Output(together, "a table")])
    made = exported(
        source, output, to=to, table=table, points=points, pressures=pressures, quantiles=quantile,
        units=units,
    )  # fmt: skip
    words = [f"{table}, mean over the surfaces", *["the same for a quantile"] * (len(made) - 2), "all curves"]
    if to == "json":
        words = ["pressure, area and conductance against the gap"]
    news(*(f"{path}: {what}" for path, what in zip(made, words, strict=True)))
