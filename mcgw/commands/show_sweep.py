"""What ``mcgw show`` says of the file of a sweep."""

import argparse

from mcgw.commands.outputs import check_outputs
from mcgw.commands.table_option import table_output, write_table
from mcgw.errors import StoreError
from mcgw.store.trailer import check_trailer
from mcgw.sweeps.file import open_sweep, read_attributes
from mcgw.sweeps.folder import SweepFolder, folder_of

__all__ = ["show_sweep", "show_unfinished"]


def show_sweep(args: argparse.Namespace) -> int:
    """Print to standard output; with --csv, write the table there."""
    if args.verify:
        return _verified(args)
    attributes = read_attributes(args.file)
    if args.scene:
        print(attributes["scene"], end="")
    elif args.digest:
        print(attributes["digest"])
    else:
        check_outputs(table_output(args.csv), inputs=[args.file])
        sweep = open_sweep(args.file)
        print(sweep)
        print(f"  digest  {attributes['digest']}")
        print(f"  made    {attributes['date']} in {attributes['wall_seconds']:.3g} s on {attributes['cpu']}")
        print(f"  with    {attributes['versions']}; commit {attributes['commit']}")
        write_table(args.csv, sweep.table)
    return 0


def show_unfinished(args: argparse.Namespace) -> int:
    """How far a sweep has come that is not yet in its file; with --scene, what all of its points come from.

    Raises
    ------
    StoreError
        If something is asked for that only a finished one has, or it cannot be read.
    """
    run = SweepFolder.open(folder_of(args.file))
    if args.scene:
        print(run.asked.texts()[0], end="")
        return 0
    if args.verify or args.digest or args.csv:
        raise StoreError(f"{args.file}: is a sweep in the making; mcgw sweep goes on, then ask again")
    missing, axes = sum(chunk.n for chunk in run.missing()), run.asked.axes
    total = sum(chunk.n for chunk in run.chunks)
    print(
        f"{args.file}: a sweep of {axes.size} points over {', '.join(axes.keys)}, not finished: "
        f"{total - missing} of {total} surfaces are drawn; the same mcgw sweep goes on"
    )
    return 0


def _verified(args: argparse.Namespace) -> int:
    """Whether every bit is as it was written."""
    try:
        check_trailer(args.file)
        open_sweep(args.file)
    except StoreError as error:
        print(f"{args.file}: DAMAGED, {str(error).removeprefix(f'{args.file}: ')}")
        return 1
    print(f"{args.file}: intact ({read_attributes(args.file)['digest']})")
    return 0
