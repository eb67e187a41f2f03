"""``mcgw merge``: one file of the blocks that jobs have drawn."""

import argparse
from pathlib import Path

HELP = "make the file of a run whose blocks were drawn by several jobs (mcgw run --shard i/n)"
EXAMPLE = "mcgw merge demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "file", nargs="?", type=Path, metavar="FILE", help="the file to be made, as given to run -o"
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="the file to be made; default: FILE"
    )


def execute(args: argparse.Namespace) -> int:
    """Merge and say where the file is."""
    from mcgw.joining import merge

    path = args.file or args.output
    if path is None:
        raise ValueError("give the file to be made: mcgw merge FILE")
    ensemble = merge(path)
    print(f"{path}: {ensemble.n_surfaces} surfaces, seed {ensemble.scene.seed}")
    return 0
