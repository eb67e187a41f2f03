"""``mcgw solve``: answers at a given load."""

import argparse
from pathlib import Path

from mcgw.commands.options import RANGE, add_set_option, changes_of, ranged

HELP = "find separation, area, stiffness, contacts and conductance at given loads"
EXAMPLE = "mcgw solve runs/demo.toml --pressure 100kPa 1MPa --csv solved.csv"

# Arguments of `mcgw.solve`: a letter and the help of each.
_GIVEN = {
    "pressure": ("P", "load per nominal area: Pa, kPa, MPa, GPa"),
    "load": ("F", "mN, N, kN, MN"),
    "area": ("A", "real area: um^2, mm^2, cm^2"),
    "area_fraction": ("A", "real over nominal area: 0.01 or 1%%"),
    "nominal_separation": ("D", "separation of the bodies with an interaction, over sigma"),
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("scene", type=Path, metavar="SCENE", help="TOML file, SI units")
    given = parser.add_mutually_exclusive_group(required=True)
    for name, (letter, words) in _GIVEN.items():
        how = "at a constant ratio" if name in ("pressure", "load") else "at equal steps"
        words = f"{words}; or {RANGE}, {how}"
        given.add_argument(f"--{name.replace('_', '-')}", nargs="+", metavar=letter, help=words)
    parser.add_argument(
        "--surfaces", type=int, metavar="M", help="number of surfaces to solve; default: that of the scene"
    )
    parser.add_argument(
        "--scatter", metavar="S", help="also find the number of asperities for this scatter of specimens: 1%%"
    )
    parser.add_argument(
        "--csv", type=Path, metavar="FILE", help="also write the table to this file; default: no file"
    )
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Print the answers as a table; with --csv, also write it."""
    from dataclasses import replace

    from mcgw.commands.outputs import check_outputs, table_output, write_table
    from mcgw.commands.voice import ALL, says, tell_cautions
    from mcgw.ensemble.solution import UNIT_OF, given_values, solutions
    from mcgw.ensemble.solved import at_solutions
    from mcgw.formats.units import parse
    from mcgw.machine.progress import bar
    from mcgw.reports.solved_loads import solutions_table, solutions_text
    from mcgw.scene.scene_file import files_of, load_scene

    scene = load_scene(args.scene, changes=changes_of(args))
    check_outputs(table_output(args.csv), inputs=files_of(args.scene))
    if args.surfaces is not None:
        scene = replace(scene, n_surfaces=args.surfaces)
    key = next(name for name in _GIVEN if getattr(args, name))
    option = f"--{key.replace('_', '-')}"
    asked: list[str | float] = []
    for text in getattr(args, key):
        asked += ranged(text, option, UNIT_OF[key]) if ":" in text else [text]
    given, values = given_values(
        scene, key, asked, lambda x, unit: x if isinstance(x, float) else parse(x, unit, option)
    )
    scatter = None if args.scatter is None else parse(args.scatter, "1", "--scatter")
    if scatter is not None and not 0 < scatter < 1:
        raise ValueError(f"--scatter {args.scatter}: give a number between 0 and 1, such as 1%")
    with bar("surfaces", terminal=True) as tell:
        found = solutions(scene, given, values, tell, draw=says(ALL))
    print(solutions_text(scene, found, scatter, full=says(ALL)))
    tell_cautions(at_solutions(scene, found), "add -v")
    write_table(args.csv, lambda: solutions_table(scene, found))
    return 0
