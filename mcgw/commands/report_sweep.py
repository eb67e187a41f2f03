"""``mcgw report`` of the file of a sweep."""

import argparse
import sys
from pathlib import Path

from mcgw.commands.outputs import HTML, Output, check_outputs
from mcgw.formats.files import write_whole
from mcgw.machine.progress import bar
from mcgw.reports.sweep_html import sweep_report_html
from mcgw.statistics.sweep_comparison import compare_sweep
from mcgw.sweeps.cautions import sweep_cautions
from mcgw.sweeps.file import open_sweep, read_attributes

__all__ = ["report_sweep"]


def report_sweep(args: argparse.Namespace, path: Path) -> int:
    """Write the page and say where it is."""
    check_outputs([Output(path, HTML)], inputs=[args.file])
    sweep = open_sweep(args.file)
    cautions = sweep_cautions(sweep)
    for line in cautions:
        print(f"mcgw: note: {line}", file=sys.stderr)
    with bar("points", terminal=True) as show:
        comparison = compare_sweep(sweep, progress=show)
    page = sweep_report_html(comparison, cautions, read_attributes(args.file))
    write_whole(path, [page.encode()])
    print(f"{path}: report, {len(page.encode()) / 1e6:.2f} MB; open it in a browser")
    return 0
