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
    return _of_scene(args) if args.scene else _of_paper(args)


def _of_paper(args: argparse.Namespace) -> int:
    from importlib.resources import files

    from mcgw.figures.drawing import save_figures
    from mcgw.figures.further import FURTHER, further_figures
    from mcgw.figures.paper import PAPER, paper_figures
    from mcgw.figures.samples import Samples
    from mcgw.scene.scene_file import scene_from

    _check(args, (*PAPER, *FURTHER))
    scene = scene_from((files("mcgw.scene") / "presets" / "demo.toml").read_text(encoding="utf-8"))
    samples = Samples(scene.surface, 2000, scene.n_asperities, scene.seed, 100)
    for path in save_figures(paper_figures(samples) + further_figures(samples), args.output, csv=args.csv):
        print(path)
    return 0


def _of_scene(args: argparse.Namespace) -> int:
    from mcgw.figures.drawing import save_figures
    from mcgw.figures.of_scene import OF_SCENE, scene_figures
    from mcgw.scene.scene_file import load_scene

    scene = load_scene(args.scene)
    _check(args, OF_SCENE)
    for name, figure in scene_figures(scene):
        if isinstance(figure, str):
            print(f"{name}: not drawn: {figure}")
            continue
        for path in save_figures([figure], args.output, csv=args.csv):
            print(path)
    return 0


def _check(args: argparse.Namespace, names: tuple[str, ...]) -> None:
    """That all files can be written, and none is an input."""
    from mcgw.commands.outputs import CSV, Output, check_outputs, figure_format
    from mcgw.figures.drawing import figure_files
    from mcgw.scene.scene_file import files_of

    check_outputs(
        [
            Output(path, CSV if path.suffix == ".csv" else figure_format())
            for name in names
            for path in figure_files(args.output, name, csv=args.csv)
        ],
        inputs=files_of(args.scene) if args.scene else (),
    )
