"""What ``mcgw compare`` says of the file of a sweep."""

import argparse
import sys
from pathlib import Path

from mcgw.commands.outputs import Output, check_outputs, figure_format
from mcgw.commands.table_option import table_output, write_table
from mcgw.machine.progress import bar
from mcgw.statistics.sweep_comparison import compare_sweep
from mcgw.sweeps.cautions import sweep_cautions
from mcgw.sweeps.file import open_sweep

__all__ = ["compare_with_theory"]

_LISTED = 12  # points


def compare_with_theory(args: argparse.Namespace, path: Path) -> int:
    """Print cautions, the worst points and the verdict; save the figure."""
    check_outputs([Output(path, figure_format()), *table_output(args.csv)], inputs=[args.file])
    from mcgw.figures.sweep_comparison import save_sweep_comparison

    sweep = open_sweep(args.file)
    for line in sweep_cautions(sweep):
        print(f"mcgw: note: {line}", file=sys.stderr)
    with bar("points", terminal=True) as show:
        comparison = compare_sweep(sweep, progress=show)
    save_sweep_comparison(comparison, path)
    print(comparison.sheet_of(_LISTED).text())
    write_table(args.csv, comparison.table)
    print("", comparison.verdict.line, f"{path}: figure", sep="\n")
    return 0 if comparison.verdict.agrees else 1
