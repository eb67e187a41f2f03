"""``mcgw show``: what is in a file."""

import argparse
from pathlib import Path

HELP = "show what an ensemble file holds"
EXAMPLE = "mcgw show demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file (HDF5)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--scene", action="store_true", help="print the scene as TOML: it runs again")
    what.add_argument("--digest", action="store_true", help="print the digest of scene and data")
    what.add_argument("--verify", action="store_true", help="compare the data with the digest in the file")


def execute(args: argparse.Namespace) -> int:
    """Print to standard output; writes no file."""
    from mcgw.store import file_digest, open_ensemble, read_attributes

    attributes = read_attributes(args.file)
    if args.scene:
        print(attributes["scene"], end="")
    elif args.digest:
        print(attributes["digest"])
    elif args.verify:
        found = file_digest(args.file)
        good = found == attributes["digest"]
        print(f"{args.file}: {'intact' if good else 'DAMAGED'} ({found})")
        return 0 if good else 1
    else:
        from mcgw.report_text import summary

        print(summary(open_ensemble(args.file), attributes))
    return 0
