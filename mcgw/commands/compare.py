"""``mcgw compare``: Monte Carlo against theory."""

import argparse
from pathlib import Path

HELP = "compare an ensemble or a sweep with theory: verdict and figure (exit code 1 if they disagree)"
EXAMPLE = "mcgw compare demo.h5 -o demo.png"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="file of an ensemble or of a sweep (HDF5)")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="PNG", help="figure (.png, .pdf, .svg, ...); default: FILE.png"
    )
    parser.add_argument(
        "--csv", type=Path, metavar="FILE", help="also write the table, of at most 100 separations"
    )
    parser.add_argument(
        "--table", action="store_true", help="print all means beside theory, not only the worst three"
    )
    parser.add_argument(
        "--laws",
        action="store_true",
        help="also test the values of single surfaces against their exact distribution",
    )


def execute(args: argparse.Namespace) -> int:
    """Print the verdict and the means farthest from theory, save the figure."""
    from mcgw.commands.outputs import Output, check_outputs, figure_format, table_output, write_table
    from mcgw.commands.voice import ALL, news, says, tell_cautions
    from mcgw.machine.progress import bar
    from mcgw.statistics.comparison import compare
    from mcgw.sweeps import open_results

    path = args.output or args.file.with_suffix(".png")
    result = open_results(args.file)
    check_outputs([Output(path, figure_format()), *table_output(args.csv)], inputs=[args.file])
    from mcgw.figures.against_theory import save_comparison
    from mcgw.reports.text import comparison_summary

    with bar("points", terminal=True) as show:
        comparison = compare(result, laws=args.laws, progress=show)
    save_comparison(comparison, path)
    whole = args.table or says(ALL)
    text, table, verdict = comparison_summary(comparison, whole=whole)
    news(*verdict, f"{path}: figure")
    write_table(args.csv, table)
    news(f"next: mcgw report {args.file}")
    tell_cautions(result, f"mcgw show {args.file}")
    news(text)
    return 0 if comparison.verdict.agrees else 1
