"""``mcgw export``: contact tables for finite-element programs."""

import argparse
from pathlib import Path

from mcgw.commands.options import add_set_option, changes_of, ranged

HELP = "write pressure, conductance or stiffness as a table for a finite-element program"
EXAMPLE = "mcgw export mine.toml --to calculix --units mm-N-s -o contact.inp"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "scene", type=Path, metavar="SCENE_OR_FILE",
        help="scene (TOML), whose surfaces are drawn as needed; or an ensemble file (HDF5)",
    )  # fmt: skip
    parser.add_argument(
        "--to",
        required=True,
        choices=("calculix", "abaqus", "moose", "comsol", "json"),
        help="the program; json: one file with all columns against the gap in SI units, and their origin",
    )
    parser.add_argument(
        "--table", default="pressure-gap",
        choices=("pressure-gap", "conductance-pressure", "conductance-gap", "stiffness-pressure"),
        help="the quantity and its argument; default: pressure-gap",
    )  # fmt: skip
    parser.add_argument("--points", type=int, default=40, metavar="N", help="number of rows; default: 40")
    parser.add_argument(
        "--pressures", metavar="A:B:N",
        help="N nominal pressures from A to B at a constant ratio, such as 10kPa:20MPa:30; default: those "
        "that the separations of the scene span",
    )  # fmt: skip
    parser.add_argument(
        "--quantile", type=float, nargs="+", metavar="Q",
        help="quantiles over the surfaces, besides the mean; default: 0.05 and 0.95",
    )  # fmt: skip
    parser.add_argument(
        "--units", default="SI", choices=("SI", "mm-N-s"), help="units of the files; default: SI"
    )
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE",
        help="file of the mean: .inp, for moose .csv, for comsol .txt, for json .json; quantiles and a joint "
        "table go beside it",
    )  # fmt: skip
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Write the files and say where they are."""
    from mcgw.commands.outputs import CSV, Format, Output, check_outputs
    from mcgw.commands.voice import news, tell_cautions
    from mcgw.exports.curves import quantile_name
    from mcgw.exports.programs import PROGRAMS, check_name
    from mcgw.exports.writing import DEFAULT_QUANTILES, export, files_of_export
    from mcgw.scene.scene_file import files_of, load_scene
    from mcgw.store.ensembles import open_ensemble

    whole = args.to == "json"
    if not whole:
        check_name(args.output.name, PROGRAMS[args.to])
    pressures = None if args.pressures is None else ranged(args.pressures, "--pressures", "Pa")
    from_scene = args.scene.suffix.lower() == ".toml"
    if args.set and not from_scene:
        raise ValueError(f"--set {args.set[0]}: {args.scene} holds results; give a scene")
    what = load_scene(args.scene, changes=changes_of(args)) if from_scene else args.scene
    scene = what if from_scene else open_ensemble(args.scene).scene
    form = Format(f"a table for {args.to}", (".json",) if whole else PROGRAMS[args.to].endings)
    names = ["mean", *(quantile_name(q) for q in args.quantile or DEFAULT_QUANTILES)]
    *tables, all_of_them = files_of_export(args.output, names)
    outputs = [Output(path, form) for path in ([args.output] if whole else tables)]
    outputs += [] if whole else [Output(all_of_them, CSV)]
    check_outputs(outputs, inputs=files_of(args.scene) if from_scene else [args.scene])
    made = export(
        what, args.output, to=args.to, table=args.table, points=args.points, pressures=pressures,
        quantiles=args.quantile, units=args.units,
    )  # fmt: skip
    if whole:
        news(f"{made[0]}: pressure, area and conductance against the gap")
    else:
        mean, *quantiles, together = made
        news(f"{mean}: {args.table}, mean over the surfaces")
        news(*(f"{path}: the same for a quantile" for path in quantiles), f"{together}: all curves")
    tell_cautions(scene, f"mcgw show {'--plan ' * from_scene}{args.scene}")
    return 0
