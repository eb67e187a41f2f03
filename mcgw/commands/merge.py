"""``mcgw merge``: join the blocks drawn by jobs into one file."""

import argparse
from pathlib import Path

HELP = "merge the blocks of a run or sweep that several jobs drew (--shard i/n) into one file"
EXAMPLE = "mcgw merge demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "file", nargs="?", type=Path, metavar="FILE", help="the file to make, as given to run -o"
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="the file to make; default: FILE")


def execute(args: argparse.Namespace) -> int:
    """Merge and print the path of the file."""
    from mcgw.commands.outputs import HDF5, Output, check_outputs
    from mcgw.commands.voice import look_next, news
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.formats.files import state_of
    from mcgw.jobs.making import merge

    path = args.file or args.output
    if path is None:
        raise ValueError("give the file to make: mcgw merge FILE")
    if args.output not in (None, path):
        raise ValueError(f"-o {args.output}: the blocks belong to {path}; leave out one of the two names")
    check_outputs([Output(path, HDF5, grows=True)])
    before = state_of(path)
    merged = merge(path)
    done = "was finished before, " if state_of(path) == before else ""
    if isinstance(merged, Ensemble):
        scene, made = merged.scene, f"{merged.n_surfaces} surfaces"
    else:
        scene, made = merged.scenes[0], f"{merged.axes.size} scenes"
    news(f"{path}: {done}{made}, seed {scene.seed}")
    look_next(path)
    return 0
