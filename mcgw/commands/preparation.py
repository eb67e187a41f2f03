"""Options that say what is done to a measured map before it is looked at."""

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcgw.maps.preparation import Preparation

__all__ = ["preparation", "preparation_arguments"]

_FORMS = ("plane", "none", "quadratic", "cubic", "quartic", "sphere", "cylinder")


def preparation_arguments(parser: argparse.ArgumentParser) -> None:
    """Add them."""
    parser.add_argument(
        "--cutoff", required=True, metavar="LENGTH",
        help="shortest wavelength that counts, as 5um (Gaussian filter, ISO 16610-61); or none",
    )  # fmt: skip
    parser.add_argument(
        "--long-cutoff", metavar="LENGTH", help="longest wavelength that counts, as 80um; default: all do"
    )
    parser.add_argument("--form", choices=_FORMS, default="plane", help="what is taken off; default: plane")
    parser.add_argument(
        "--missing", choices=("auto", "mask", "fill"), default="auto",
        help="missing points are filled from the edges of their holes; mask: they and their neighbours do "
        "not count, fill: they do; auto: mask, while half of the others are left; default: auto",
    )  # fmt: skip
    parser.add_argument(
        "--spikes", choices=("keep", "remove"), default="keep",
        help="whether points that stand out become missing; default: keep",
    )  # fmt: skip
    parser.add_argument(
        "--step", choices=("keep", "crop"), default="keep",
        help="whether of two terraces only the larger is kept; default: keep",
    )  # fmt: skip
    parser.add_argument(
        "--lines", choices=("keep", "rows", "columns"), default="keep",
        help="take off offsets between rows or columns, as of a scan line by line; default: keep",
    )  # fmt: skip
    parser.add_argument(
        "--trim", type=int, default=0, metavar="N", help="points left off along each edge; default: 0"
    )


def preparation(args: argparse.Namespace) -> "Preparation":
    """What they say.

    Raises
    ------
    ValueError
        If a length or a number is none.
    """
    from mcgw.formats.units import parse
    from mcgw.maps.preparation import Preparation

    if args.trim < 0:
        raise ValueError(f"--trim {args.trim}: give a whole number >= 0")
    cutoff = None if args.cutoff == "none" else parse(args.cutoff, "m", "--cutoff")
    long = None if args.long_cutoff is None else parse(args.long_cutoff, "m", "--long-cutoff")
    return Preparation(cutoff, args.form, args.missing, args.spikes, args.step, args.trim, long, args.lines)
