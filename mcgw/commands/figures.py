"""``mcgw figures``: the paper's figures with Monte Carlo on top, and those it lacks; or those of a scene."""

import argparse
from pathlib import Path

HELP = "draw the paper's Figures 1-6 with Monte-Carlo points, and those it lacks (a minute)"
EXAMPLE = "mcgw figures --scene mine.toml -o figures --csv"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", default=Path("figures"), help="default: figures here"
    )
    parser.add_argument(
        "--scene", type=Path, metavar="SCENE", help="of this scene instead, beside its homogeneous reference"
    )
    parser.add_argument("--csv", action="store_true", help="also write the numbers of each figure")


def execute(args: argparse.Namespace) -> int:
    """Write PNG, PDF and SVG of each figure and say where they are."""
    from mcgw.commands.outputs import CSV, Output, check_outputs, figure_format
    from mcgw.figures.catalogue import figures_of, of_paper, rows_of
    from mcgw.figures.compared import Compared
    from mcgw.figures.panels import figure_files, save_figure_files
    from mcgw.scene.scene_file import files_of, load_scene

    compared, figure = Compared(load_scene(args.scene)) if args.scene else of_paper(), figure_format()
    check_outputs(
        [
            Output(path, CSV if path.suffix == ".csv" else figure)
            for row in rows_of(compared)
            for path in figure_files(args.output, row.name, csv=args.csv)
        ],
        inputs=files_of(args.scene) if args.scene else (),
    )
    for name, data in figures_of(compared):
        if isinstance(data, str):
            print(f"{name}: not drawn: {data}")
            continue
        for path in save_figure_files(data, args.output, csv=args.csv):
            print(path)
    return 0
