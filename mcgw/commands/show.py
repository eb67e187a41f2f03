"""``mcgw show``: what is in a file."""

import argparse
from pathlib import Path

HELP = "show what an ensemble file holds, or how far its run has come"
EXAMPLE = "mcgw show demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file (HDF5)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--scene", action="store_true", help="print the scene as TOML: it runs again")
    what.add_argument("--digest", action="store_true", help="print the digest of scene and data")
    what.add_argument(
        "--plan", action="store_true", help="FILE is a scene (TOML): print what would be drawn, and what not"
    )
    parser.add_argument(
        "--csv", type=Path, metavar="CSV", help="also write the table of all separations there"
    )
    what.add_argument("--verify", action="store_true", help="check every bit by trailer and digest")


def execute(args: argparse.Namespace) -> int:
    """Print to standard output; with --csv, write the table there."""
    from mcgw.commands.notes import tell_notes
    from mcgw.commands.outputs import check_outputs
    from mcgw.commands.table_option import table_output, write_table
    from mcgw.store.disk import parts_of
    from mcgw.store.ensembles import filetype_of, open_ensemble, read_attributes, verify
    from mcgw.store.leftovers import tidy

    if args.csv and (args.scene or args.digest or args.plan or args.verify):
        raise ValueError(f"--csv {args.csv}: writes the table of the summary; leave out the other option")
    if args.plan:
        from mcgw.machine.progress import stages
        from mcgw.reports.plan import plan_of, plan_text
        from mcgw.scene.scene_file import load_scene

        scene = load_scene(args.file)
        with stages(2) as done:
            tell_notes(scene)
            done()
            plan = plan_of(scene)
        print(plan_text(scene, plan))
        return 0
    tidy(args.file)
    if not args.file.exists() and parts_of(args.file).joinpath("sweep").is_dir():
        from mcgw.commands.show_sweep import show_unfinished

        return show_unfinished(args)
    if filetype_of(args.file) == "mcgw-sweep":
        from mcgw.commands.show_sweep import show_sweep  # of which most files are none

        return show_sweep(args)
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
        from mcgw.ensemble.tables import statistics_table
        from mcgw.formats.table import stacked
        from mcgw.reports.text import summary

        ensemble = open_ensemble(args.file)
        check_outputs(table_output(args.csv), inputs=[args.file])
        tell_notes(ensemble.scene)
        print(summary(ensemble, attributes))
        names = ensemble.scene.quantities
        write_table(
            args.csv,
            lambda: stacked({name: statistics_table(ensemble, name) for name in names}, "quantity"),
        )
    return 0
