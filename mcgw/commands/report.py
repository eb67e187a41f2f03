"""``mcgw report``: an ensemble as one HTML page."""

import argparse
from pathlib import Path

HELP = "write a report: one HTML page with figures, tables, verdict and provenance"
EXAMPLE = "mcgw report demo.h5 -o demo.html"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="file of an ensemble (HDF5)")
    parser.add_argument("-o", "--output", type=Path, metavar="HTML", help="default: FILE.html")


def execute(args: argparse.Namespace) -> int:
    """Write the page and print its path."""
    from mcgw.commands.outputs import HTML, Output, check_outputs
    from mcgw.commands.voice import news, tell_cautions
    from mcgw.formats.files import write_whole
    from mcgw.reports.html import report_html
    from mcgw.store.ensembles import open_ensemble, read_attributes

    path = args.output or args.file.with_suffix(".html")
    ensemble = open_ensemble(args.file)
    check_outputs([Output(path, HTML)], inputs=[args.file])
    page = report_html(ensemble, read_attributes(args.file))
    write_whole(path, [page.encode()])
    news(f"{path}: report, {len(page.encode()) / 1e6:.2f} MB; open it in a browser")
    tell_cautions(ensemble, f"mcgw show {args.file}")
    return 0
