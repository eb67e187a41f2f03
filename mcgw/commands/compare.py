"""``mcgw compare``: Monte Carlo against theory."""

import argparse
from pathlib import Path

HELP = "compare an ensemble or a sweep with theory: table, figure, verdict (exit code 1 if they disagree)"
EXAMPLE = "mcgw compare demo.h5 -o demo.png"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file, or that of a sweep (HDF5)")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="PNG", help="figure (.png, .pdf, .svg, ...); default: FILE.png"
    )
    parser.add_argument("--csv", type=Path, metavar="FILE", help="also write the table of all separations")


def execute(args: argparse.Namespace) -> int:
    """Print table and verdict, save the figure."""
    from mcgw.commands.notes import tell_notes
    from mcgw.commands.outputs import Output, check_outputs, figure_format
    from mcgw.commands.table_option import table_output, write_table
    from mcgw.formats.table import stacked
    from mcgw.reports.elasticity import against_elasticity
    from mcgw.reports.text import comparison_text, verdict_line
    from mcgw.statistics.comparison import compare
    from mcgw.store.ensembles import filetype_of, open_ensemble

    path = args.output or args.file.with_suffix(".png")
    if filetype_of(args.file) == "mcgw-sweep":
        from mcgw.commands.compare_sweep import compare_with_theory  # of which most files are none

        return compare_with_theory(args, path)
    ensemble = open_ensemble(args.file)
    check_outputs([Output(path, figure_format()), *table_output(args.csv)], inputs=[args.file])
    from mcgw.figures.comparison import save_comparison

    tell_notes(ensemble.scene)
    comparison = compare(ensemble)
    save_comparison(comparison, path)
    print(comparison_text(comparison))
    write_table(args.csv, lambda: stacked(comparison.tables(), "quantity"))
    known = against_elasticity(ensemble.scene.validity())
    print("", verdict_line(comparison.verdict), *known, f"{path}: figure", sep="\n")
    return 0 if comparison.verdict.agrees else 1
