"""``mcgw tradeoff``: error against time of a scene on this machine."""

import argparse
from pathlib import Path

from mcgw.commands.options import add_set_option, changes_of

HELP = "measure what each answer costs, how exact it is, and recommend a way"
EXAMPLE = "mcgw tradeoff runs/demo.toml -o out"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("scene", type=Path, metavar="SCENE", help="TOML file, SI units")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="DIR",
        help="folder of table and figure; default: out beside the scene",
    )
    parser.add_argument(
        "--seconds", default="60", metavar="TIME", help="time limit, such as 5 min; default: 60 (s)"
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print the advice, save the record and the figure."""
    from mcgw.commands.outputs import CSV, Output, check_outputs, figure_format
    from mcgw.commands.voice import details, news, tell_cautions
    from mcgw.ensemble.prices import TARGETS
    from mcgw.figures.studies import save_tradeoff
    from mcgw.formats.units import parse
    from mcgw.machine.progress import bar
    from mcgw.scene.scene_file import files_of, load_scene
    from mcgw.statistics.tradeoff import tradeoff

    seconds = parse(args.seconds, "s", "--seconds")
    scene = load_scene(args.scene, changes=changes_of(args))
    folder = args.output or args.scene.parent / "out"
    table, measured, figure = (
        folder / f"{args.scene.stem}-tradeoff{end}" for end in (".csv", "-measured.csv", ".png")
    )
    outputs = [Output(table, CSV), Output(measured, CSV), Output(figure, figure_format())]
    check_outputs(outputs, inputs=files_of(args.scene))
    with bar("s", terminal=True) as show:
        found = tradeoff(scene, seconds=seconds, progress=show)
    found.table().write(table)
    found.measurements().write(measured)
    save_tradeoff(found, figure)
    news(found.sheet(TARGETS).text())
    news(f"{table}: what to run for each error ({found.seconds:.0f} s)", f"{figure}: figure")
    details("", found.measurements().text())
    tell_cautions(scene, f"mcgw show --plan {args.scene}")
    return 0
