"""``mcgw converge``: the statistical convergence test of a scene."""

import argparse
from pathlib import Path

from mcgw.commands.options import add_set_option, changes_of

HELP = (
    "test statistical convergence: slopes, coverage, variance, covariance, skewness (exit code 1 if it fails)"
)
EXAMPLE = "mcgw converge runs/demo.toml -o out"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("scene", type=Path, metavar="SCENE", help="TOML file, SI units")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", help="folder of the figure; default: out beside the scene"
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print the verdict, and every check if one fails; save the figure."""
    from mcgw.commands.outputs import Output, check_outputs, figure_format
    from mcgw.commands.voice import ALL, news, says, tell_cautions
    from mcgw.figures.studies import save_convergence
    from mcgw.machine.progress import bar
    from mcgw.scene.scene_file import files_of, load_scene
    from mcgw.statistics.convergence import SEEDS, converge

    scene = load_scene(args.scene, changes=changes_of(args))
    folder = args.output or args.scene.parent / "out"
    path = folder / f"{args.scene.stem}-converge.png"
    check_outputs([Output(path, figure_format())], inputs=files_of(args.scene))
    with bar("ensembles", terminal=True) as show:
        found = converge(scene, progress=show)
    save_convergence(found, path)
    many = f"{SEEDS} ensembles of {found.scene.n_surfaces} surfaces"
    news(f"convergence {found.word}: p = {found.p:.3g} over all checks of {many}", f"{path}: figure")
    if says(ALL) or not found.passed:
        news(found.table().text())
    tell_cautions(scene, f"mcgw show --plan {args.scene}")
    return 0 if found.passed else 1
