"""``mcgw elastic``: the mean of elastic surfaces."""

import argparse
from pathlib import Path

from mcgw.commands.options import add_set_option, changes_of

HELP = "find mean area, stiffness, conductance and gap of elastic surfaces by few boundary-element solves"
EXAMPLE = "mcgw elastic spectral.toml --pressure 1MPa --rel-err 0.05 -o solves.jsonl"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "source", type=Path, metavar="SCENE|MAP",
        help="a scene with m0, m2, m4 or from a fit (.toml); or a height map, whose spectrum is taken",
    )  # fmt: skip
    parser.add_argument("--pressure", required=True, metavar="P", help="load per nominal area: kPa, MPa, GPa")
    parser.add_argument("--E-star", metavar="E", help="composite modulus of a map: MPa, GPa")
    parser.add_argument(
        "--rel-err", type=float, default=0.02, metavar="X",
        help="half the 95 %% interval over the mean, of the worst quantity; default: 0.02",
    )  # fmt: skip
    parser.add_argument("--solves", type=int, metavar="N", help="instead: boundary-element solves at most")
    parser.add_argument("--seed", type=int, default=1, metavar="K", help="of the maps; default: 1")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="solves, a line each (.jsonl), to resume from; default: none",
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print the means, their intervals, and what the levels saved."""
    from mcgw.commands.outputs import JSONL, Output, check_outputs
    from mcgw.commands.voice import details, news
    from mcgw.elasticity.elastic import elastic
    from mcgw.machine.progress import bar
    from mcgw.scene.scene_file import load_scene

    source = (
        load_scene(args.source, changes=changes_of(args)) if args.source.suffix == ".toml" else args.source
    )
    check_outputs([Output(args.output, JSONL)] if args.output else [], inputs=[args.source])
    with bar("s", terminal=True) as tell:
        found = elastic(
            source, pressure=args.pressure, E_star=args.E_star, rel_err=args.rel_err, solves=args.solves,
            seed=args.seed, path=args.output, progress=tell,
        )  # fmt: skip
    print(found)
    details(found.levels)
    news(*([f"{args.output}: the solves; the same command resumes from them"] if args.output else []))
    return 0
