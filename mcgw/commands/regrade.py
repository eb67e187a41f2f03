"""``mcgw regrade``: another grading on the same surfaces."""

import argparse
from pathlib import Path

HELP = "give the surfaces of a file another grading, without drawing them again"
EXAMPLE = 'mcgw regrade demo.h5 --gamma 0.5 -o softer.h5   # simulated with keep = "moments"'


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file that keeps its moments")
    grading = parser.add_mutually_exclusive_group(required=True)
    grading.add_argument(
        "--gamma", type=float, metavar="G", help="exponential grading, Eq. (4); 1 is homogeneous"
    )
    grading.add_argument("--grading", type=Path, metavar="TABLE.csv", help="columns s or z, ratio or E_star")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.h5", help="default: FILE.regraded.h5")
    parser.add_argument(
        "--csv", type=Path, metavar="CSV", help="also write the ratios at all separations there"
    )


def execute(args: argparse.Namespace) -> int:
    """Write the new ensemble and print its ratios to the old one."""
    from dataclasses import replace

    from analytic import Exponential
    from mcgw.commands.outputs import HDF5, Output, check_outputs
    from mcgw.commands.table_option import table_output, write_table
    from mcgw.ensemble.regrading import regrade
    from mcgw.reports.text import RATIO_HEADER, ratio_rows, ratio_table
    from mcgw.scene.grading_section import read_grading
    from mcgw.store.ensembles import finished, open_ensemble
    from mcgw.store.saving import save

    old = open_ensemble(args.file)
    table, gamma = args.grading, args.gamma
    grading = read_grading(table, old.scene.surface) if table else Exponential(gamma)
    path = args.output or args.file.with_suffix(".regraded.h5")
    inputs = [args.file, table] if table else [args.file]
    check_outputs([Output(path, HDF5, grows=True), *table_output(args.csv)], inputs=inputs)
    finished(path, replace(old.scene, grading=grading, n_surfaces=old.n_surfaces), old.sampler)
    new = save(regrade(old, grading), path)
    print(ratio_table(new, old))
    print(f"{path}: {new.n_surfaces} surfaces, the same as in {args.file}")
    write_table(args.csv, RATIO_HEADER, ratio_rows(new, old))
    return 0
