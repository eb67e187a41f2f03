"""``mcgw figures``: the paper's figures with Monte Carlo on top, and those it lacks."""

import argparse
from pathlib import Path

HELP = "draw the paper's Figures 1-6 with Monte-Carlo points, and those it lacks (a minute)"
EXAMPLE = "mcgw figures -o figures --csv"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", default=Path("figures"), help="default: figures here"
    )
    parser.add_argument(
        "--scene", type=Path, metavar="SCENE", help="take surface, n_asperities and seed from there"
    )
    parser.add_argument("--csv", action="store_true", help="also write the numbers of each figure")


def execute(args: argparse.Namespace) -> int:
    """Write PNG and SVG of each figure and say where they are."""
    from mcgw.commands.outputs import CSV, Output, check_outputs, figure_format
    from mcgw.figures.drawing import figure_files, save_figures
    from mcgw.figures.further import FURTHER, further_figures
    from mcgw.figures.paper import PAPER, paper_figures
    from mcgw.figures.samples import Samples
    from mcgw.scene.scene_file import files_of, load_scene, scene_from

    if args.scene:
        scene = load_scene(args.scene)
    else:
        from importlib.resources import files

        scene = scene_from((files("mcgw.scene") / "presets" / "demo.toml").read_text(encoding="utf-8"))
    if scene.n_asperities > 1_000_000:
        raise ValueError(
            f"ensemble.n_asperities = {scene.n_asperities}: figures list heights one by one; give at most 1e6"
        )
    check_outputs(
        [
            Output(path, CSV if path.suffix == ".csv" else figure_format())
            for name in (*PAPER, *FURTHER)
            for path in figure_files(args.output, name, csv=args.csv)
        ],
        inputs=files_of(args.scene) if args.scene else (),
    )
    samples = Samples(scene.surface, 2000, scene.n_asperities, scene.seed, 100)
    for path in save_figures(paper_figures(samples) + further_figures(samples), args.output, csv=args.csv):
        print(path)
    return 0
