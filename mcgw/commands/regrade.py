"""``mcgw regrade``: another grading or contact law on the same surfaces."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.commands.law_options import add_law_options, law_of

if TYPE_CHECKING:
    from analytic import Exponential

HELP = "give the surfaces of a file another grading or contact law"
EXAMPLE = "mcgw regrade demo.h5 --law kogut-etsion --hardness 1.2GPa -o metal.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file; quickest with its moments")
    grading = parser.add_mutually_exclusive_group()
    grading.add_argument(
        "--gamma", type=float, metavar="G", help="exponential grading, Eq. (4); 1 is homogeneous"
    )
    grading.add_argument("--grading", type=Path, metavar="TABLE.csv", help="columns s or z, ratio or E_star")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.h5", help="default: FILE.regraded.h5")
    parser.add_argument(
        "--csv", type=Path, metavar="CSV", help="also write the ratios at all separations there"
    )
    add_law_options(parser)


def execute(args: argparse.Namespace) -> int:
    """Write the new ensemble and print its ratios to the old one."""
    from mcgw.commands.notes import tell_notes
    from mcgw.commands.outputs import HDF5, Output, check_outputs
    from mcgw.commands.table_option import table_output, write_table
    from mcgw.ensemble.regrading import regrade, regraded_scene
    from mcgw.formats.table import stacked
    from mcgw.reports.text import ratio_tables
    from mcgw.scene.grading_section import read_grading
    from mcgw.store.ensembles import finished, open_ensemble
    from mcgw.store.saving import save

    table, gamma, law = args.grading, args.gamma, law_of(args)
    if law is None and table is None and gamma is None:
        raise ValueError("regrade: give another grading (--gamma, --grading) or contact law (--law)")
    old = open_ensemble(args.file)
    grading = read_grading(table, old.scene.surface) if table else _exponential(gamma)
    path = args.output or args.file.with_suffix(".regraded.h5")
    inputs = [args.file, table] if table else [args.file]
    check_outputs([Output(path, HDF5, grows=True), *table_output(args.csv)], inputs=inputs)
    asked = regraded_scene(old, grading, law)
    tell_notes(asked)
    finished(path, asked, old.sampler)
    new = save(regrade(old, grading, law=law), path)
    ratios = ratio_tables(new, old)
    for ratio in ratios.values():
        print(ratio.rows(9).text())
    print(f"{path}: {new.n_surfaces} surfaces, the same as in {args.file}")
    write_table(args.csv, lambda: stacked(ratios, "quantity"))
    return 0


def _exponential(gamma: float | None) -> "Exponential | None":
    from analytic import Exponential

    return None if gamma is None else Exponential(gamma)
