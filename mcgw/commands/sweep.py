"""``mcgw sweep``: many scenes on the same surfaces."""

import argparse
from pathlib import Path
from typing import Any

from mcgw.commands.options import (
    RANGE,
    add_drawing_options,
    add_set_option,
    changes_of,
    drawing,
    ranged,
    tell_shard,
)

HELP = "draw many scenes at once on the same surfaces: means, deviations, paired ratios; resumes"
EXAMPLE = "mcgw sweep runs/demo.toml --over grading.gamma=0.2:2:10 -o gamma.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument(
        "scene", type=Path, metavar="SCENE", help="TOML file with what all points have in common"
    )
    parser.add_argument(
        "--over",
        action="append",
        required=True,
        metavar="KEY=VALUES",
        help="a key of the scene and its values, such as ensemble.n_asperities=1e4,1e5 or "
        f"grading.gamma=0.2:2:10 ({RANGE}, at equal steps); repeat for more axes",
    )
    parser.add_argument(
        "--zip", action="store_true", help="combine the first values of all keys into one point, and so on"
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE.h5", help="default: out/NAME.sweep.h5 beside the scene"
    )
    add_drawing_options(parser)
    parser.add_argument(
        "--plan", action="store_true", help="print what would be drawn and how long it takes, without drawing"
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Draw and print the path of the file."""
    from mcgw.commands.outputs import HDF5, Output, check_outputs
    from mcgw.commands.voice import details, look_next, news
    from mcgw.jobs.running import sweep
    from mcgw.reports.text import ratios_in_words
    from mcgw.scene.scene_file import files_of, load_scene
    from mcgw.store.place import recorded_seed
    from mcgw.sweeps.axes import axes_of

    path = args.output or args.scene.parent / "out" / f"{args.scene.stem}.sweep.h5"
    over = dict(map(_axis, args.over))
    scene = load_scene(args.scene, changes=changes_of(args), seed=lambda: recorded_seed(path))
    if args.plan:
        from mcgw.reports.plan import sweep_plan_text
        from mcgw.sweeps.points import Asked

        print(sweep_plan_text(Asked.of(scene, axes_of(over, zipped=args.zip))))
        return 0
    check_outputs([Output(path, HDF5, grows=True)], inputs=files_of(args.scene))
    with drawing(args) as how:
        found = sweep(scene, over, zipped=args.zip, path=path, **how)
    if args.shard is not None:
        return tell_shard(args.shard, path, found)
    news(f"{path}: {found.axes.size} scenes, seed {scene.seed}")
    ratios = ratios_in_words(found)
    news(*ratios[:1])
    details(*ratios[1:])
    look_next(path)
    details(found)
    return 0


def _axis(text: str) -> tuple[str, list[Any]]:
    """Parse KEY=VALUES.

    Raises
    ------
    ValueError
        If the text has no such form.
    """
    key, equals, values = text.partition("=")
    if not (key and equals and values):
        raise ValueError(f"--over {text}: give KEY=VALUES, such as grading.gamma=0.2:2:10 or =0.5,1,2")
    parts = values.split(":")
    if len(parts) == 3 and all(_number(part) is not None for part in parts):
        return key, ranged(values, f"--over {key}")
    found = [(value, _number(value)) for value in values.split(",")]
    return key, [value if number is None else number for value, number in found]


def _number(text: str) -> int | float | None:
    """An int or float as in TOML; None for other text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return None
