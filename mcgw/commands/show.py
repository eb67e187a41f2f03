"""``mcgw show``: the contents of a file."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.commands.options import add_set_option, changes_of

if TYPE_CHECKING:
    from mcgw.store.run_folder import RunFolder

HELP = "show the contents of an ensemble file, or the progress of its run"
EXAMPLE = "mcgw show demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="file of an ensemble or of a sweep (HDF5)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--scene", action="store_true", help="print the scene as TOML, ready to run again")
    what.add_argument("--digest", action="store_true", help="print the digest of scene and data")
    what.add_argument(
        "--plan",
        action="store_true",
        help="FILE is a scene (TOML): print what would be drawn and how long it takes",
    )
    parser.add_argument(
        "--csv", type=Path, metavar="CSV", help="also write the table of all separations to this file"
    )
    what.add_argument("--verify", action="store_true", help="verify every number by its checksum")
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print to standard output; with --csv, write the table there."""
    from mcgw.commands.outputs import check_outputs, table_output, write_table
    from mcgw.commands.voice import ALL, says, tell_cautions
    from mcgw.store.ensembles import read_attributes, unfinished_sweep, verify
    from mcgw.store.place import tidy

    if args.csv and (args.scene or args.digest or args.plan or args.verify):
        raise ValueError(f"--csv {args.csv}: belongs to the summary; leave out the other option")
    if args.set and not args.plan:
        raise ValueError(f"--set {args.set[0]}: works only with --plan, for a scene")
    if args.plan:
        from mcgw.reports.plan import plan_of, plan_text
        from mcgw.scene.scene_file import load_scene

        scene = load_scene(args.file, changes=changes_of(args))
        print(plan_text(scene, plan_of(scene)))
        tell_cautions(scene)
        return 0
    tidy(args.file)
    if (begun := unfinished_sweep(args.file)) is not None:
        return _show_unfinished(args, begun)
    if args.verify:
        problem, found = verify(args.file)
        print(f"{args.file}: {f'DAMAGED, {problem}' if problem else 'intact'} ({found})")
        return 1 if problem else 0
    attributes = read_attributes(args.file)
    if args.scene:
        print(attributes["scene"], end="")
    elif args.digest:
        print(attributes["digest"])
    else:
        from mcgw.reports.text import summary_of
        from mcgw.sweeps import open_results

        result = open_results(args.file)
        check_outputs(table_output(args.csv), inputs=[args.file])
        text, table = summary_of(result, attributes, says(ALL))
        print(text)
        tell_cautions(result)
        write_table(args.csv, table)
    return 0


def _show_unfinished(args: argparse.Namespace, begun: "RunFolder") -> int:
    """Print the progress of an unfinished sweep; with --scene, its base scene.

    Raises
    ------
    StoreError
        If something is asked for that only a finished one has.
    """
    from mcgw.errors import StoreError
    from mcgw.reports.text import progress_of

    if args.verify or args.digest or args.csv:
        raise StoreError(f"{args.file}: is an unfinished sweep; finish it with mcgw sweep")
    print(*([begun.text] if args.scene else [progress_of(begun, args.file), "\n"]), sep="", end="")
    return 0
