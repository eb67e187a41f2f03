"""``mcgw elastic``: the mean of elastic surfaces."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.commands.options import add_set_option, changes_of

if TYPE_CHECKING:
    from mcgw.maps.topography import Topography
    from mcgw.scene.scene import Scene

HELP = "find mean area, stiffness, conductance and gap of elastic surfaces from few boundary-element solves"
EXAMPLE = "mcgw elastic spectral.toml --pressure 1MPa --rel-err 0.05 -o solves.jsonl"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "source", type=Path, metavar="SCENE|MAP",
        help="a scene with m0, m2, m4 or from a fit (.toml); or a height map, for its spectrum",
    )  # fmt: skip
    held = parser.add_mutually_exclusive_group(required=True)
    held.add_argument("--pressure", metavar="P", help="load per nominal area: kPa, MPa, GPa")
    held.add_argument("--separation", metavar="D", help="mean gap of the deformed surface: nm, um")
    parser.add_argument("--E-star", metavar="E", help="composite modulus of a map: MPa, GPa")
    parser.add_argument("--pixel", metavar="LENGTH", help="size of a pixel, if the file does not give it")
    parser.add_argument(
        "--unit", metavar="UNIT", help="unit of the heights, such as um, if the file does not give it"
    )
    parser.add_argument(
        "--rel-err", type=float, default=0.02, metavar="X",
        help="relative half width of the 95 %% interval, for the worst quantity; default: 0.02",
    )  # fmt: skip
    parser.add_argument(
        "--solves",
        type=int,
        metavar="N",
        help="instead of --rel-err: maximum number of boundary-element solves",
    )
    parser.add_argument("--seed", type=int, default=1, metavar="K", help="seed of the maps; default: 1")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="write each solve as a line (.jsonl), to resume from; default: no file",
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print the means, their intervals, and the solves that the levels saved."""
    from mcgw.commands.outputs import JSONL, Output, check_outputs
    from mcgw.commands.voice import details, news
    from mcgw.elasticity.elastic import elastic
    from mcgw.formats.units import parse
    from mcgw.machine.progress import bar
    from mcgw.maps.map_files import read_map
    from mcgw.scene.scene_file import load_scene

    source: Scene | Topography
    if args.source.suffix == ".toml":
        for option, given in (("--pixel", args.pixel), ("--unit", args.unit)):
            if given is not None:
                raise ValueError(
                    f"{option} {given}: is for a map, but {args.source} is a scene; leave it out"
                )
        source = load_scene(args.source, changes=changes_of(args))
    else:
        pixel = None if args.pixel is None else parse(args.pixel, "m", "--pixel")
        source = read_map(args.source, pixel=None if pixel is None else (pixel, pixel), unit=args.unit)
    check_outputs([Output(args.output, JSONL)] if args.output else [], inputs=[args.source])
    with bar("s", terminal=True) as tell:
        found = elastic(
            source, pressure=args.pressure, separation=args.separation, E_star=args.E_star,
            rel_err=args.rel_err, solves=args.solves, seed=args.seed, path=args.output, progress=tell,
        )  # fmt: skip
    print(found)
    details(found.levels)
    news(*([f"{args.output}: solves; the same command resumes from them"] if args.output else []))
    return 0
