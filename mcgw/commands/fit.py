"""``mcgw fit``: a scene from a measured map."""

import argparse
from pathlib import Path

HELP = "fit summit density, radius and spread to a measured height map, and write a scene"
EXAMPLE = "mcgw fit map.sdf --cutoff 5um -o fitted.toml"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    from mcgw.commands.preparation import preparation_arguments

    parser.add_argument("map", type=Path, metavar="MAP", help="SDF, X3P, .npy, .h5 or text")
    preparation_arguments(parser)
    parser.add_argument("--pixel", metavar="LENGTH", help="size of a pixel, where the file does not tell it")
    parser.add_argument(
        "--unit", metavar="UNIT", help="of the heights, as um, where the file does not tell it; default: m"
    )
    parser.add_argument(
        "--use", choices=("moments", "summits", "caps"), default="summits",
        help="which estimate goes into the scene; default: summits",
    )  # fmt: skip
    parser.add_argument(
        "--heights", choices=("gaussian", "table", "measured"), default="gaussian",
        help="gaussian, or the summits' own, resampled or just as they are; default: gaussian",
    )  # fmt: skip
    parser.add_argument(
        "--E-star", default="100 GPa", metavar="E", help="composite modulus; default: 100 GPa"
    )
    parser.add_argument(
        "--parts", type=int, default=4, help="sub-areas along each axis, for errors; default: 4"
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="SCENE", help="TOML file")


def execute(args: argparse.Namespace) -> int:
    """Print the estimates side by side with warnings, write the scene, and say where it is."""
    from mcgw.commands.outputs import NPY, TOML, Output, check_outputs
    from mcgw.commands.preparation import preparation
    from mcgw.formats.units import parse
    from mcgw.maps.cautions import cautions
    from mcgw.maps.files import files_of_map, read_map
    from mcgw.maps.fit import fit_prepared
    from mcgw.maps.fitted_scene import fitted_scene, heights_beside, write_scene
    from mcgw.maps.preparation import prepared
    from mcgw.reports.fitted import fit_lines, map_line

    if args.parts < 2:
        raise ValueError(f"--parts {args.parts}: give 2 or more, to have sub-areas to compare")
    asked = preparation(args)
    E_star = parse(args.E_star, "Pa", "--E-star")
    pixel = None if args.pixel is None else (parse(args.pixel, "m", "--pixel"),) * 2
    topography = read_map(args.map, pixel=pixel, unit=args.unit)
    beside = [Output(heights_beside(args.output), NPY)] if args.heights == "measured" else []
    check_outputs([Output(args.output, TOML), *beside], inputs=files_of_map(args.map))
    ready = prepared(topography, asked)
    fit = fit_prepared(ready, across=args.parts)
    head = map_line(args.map.name, asked, topography.assumed_unit)
    text = [head, *fit.notes, *fit_lines(fit), *(f"warning: {line}" for line in cautions(fit, ready))]
    print("\n".join(text))
    scene = fitted_scene(fit, use=args.use, heights=args.heights, E_star=E_star, title=f"Fitted to {head}")
    for path in write_scene(scene, args.output, fit if args.heights == "measured" else None, text):
        print(path)
    return 0
