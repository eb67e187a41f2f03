"""``mcgw figures``: figures of the paper with Monte Carlo, further ones, or figures of a scene."""

import argparse
from pathlib import Path

HELP = (
    "draw Figures 1-6 of the paper with Monte-Carlo points, and some more (takes a minute); or the figures "
    "of a scene"
)
EXAMPLE = "mcgw figures --scene mine.toml --only figure-2 equal-load -o figures"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", default=Path("figures"), help="default: figures here"
    )
    parser.add_argument(
        "--scene", type=Path, metavar="SCENE", help="draw this scene beside its homogeneous reference instead"
    )
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="only these figures; default: all that apply"
    )
    parser.add_argument("--format", nargs="+", metavar="FORMAT", help="png, pdf, svg, ...; default: png")
    parser.add_argument("--list", action="store_true", help="print the names of all figures without drawing")
    parser.add_argument("--csv", action="store_true", help="also write the numbers of each figure")


def execute(args: argparse.Namespace) -> int:
    """Write each figure and say where it is."""
    from mcgw.commands.outputs import CSV, Output, check_outputs, figure_format
    from mcgw.commands.voice import details, news
    from mcgw.figures.catalogue import CATALOGUE, figures_of, of_paper
    from mcgw.figures.compared import Compared
    from mcgw.figures.panels import figure_files, save_figure_files
    from mcgw.formats.files import together
    from mcgw.scene.scene_file import files_of, load_scene

    compared = Compared(load_scene(args.scene)) if args.scene else of_paper()
    names = [row.name for row in CATALOGUE]
    if args.list:
        print(*names, sep="\n")
        return 0
    for name in args.only or ():
        if name not in names:
            raise ValueError(f"--only {name}: no such figure; give one of {', '.join(names)}")
    formats = [given.lower().removeprefix(".") for given in args.format or ["png"]]
    known = figure_format()
    check_outputs(
        [
            Output(path, CSV if path.suffix == ".csv" else known)
            for name in args.only or names
            for path in figure_files(args.output, name, formats, csv=args.csv)
        ],
        inputs=files_of(args.scene) if args.scene else (),
    )
    drawn = 0
    written: list[Path] = []
    with together():
        for name, data in figures_of(compared, args.only or ()):
            if isinstance(data, str):
                (news if args.only else details)(f"{name}: not drawn: {data}")
                continue
            drawn += 1
            written += save_figure_files(data, args.output, formats, csv=args.csv)
    details(*written)
    files = f"{args.output / '*'}.{formats[0]}" if len(formats) == 1 else args.output
    news(f"{files}: {drawn} figure{'s' * (drawn != 1)}; mcgw figures --list for their names")
    return 0
