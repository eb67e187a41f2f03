"""``mcgw regrade``: another grading or contact law on the same surfaces."""

import argparse
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from analytic.laws import ContactLaw

HELP = "give the surfaces of a file another grading or contact law"
EXAMPLE = "mcgw regrade demo.h5 --law kogut-etsion --hardness 1.2GPa -o metal.h5"
_CONSTANTS = {
    "critical": ("X", "penetration over sigma at which asperities yield"),
    "hardness": ("H", "hardness of the softer body, such as 1.2GPa"),
    "yield-strength": ("SY", "yield strength of the softer body, such as 400MPa (jackson-green)"),
    "poisson": ("NU", "Poisson's ratio"),
    "bridge": ("hermite", "smooth the jumps of a fit"),
    "k": ("K", "exponent of the depth (power-law-graded)"),
    "c0": ("DEPTH", "depth at which the modulus is E*, such as 1um (power-law-graded)"),
    "thickness": ("T", "thickness of the coating, such as 0.5um (coated)"),
    "ratio": ("R", "modulus of the coating over that of the substrate (coated)"),
    "work": ("W", "work of adhesion, J/m^2 (laws that stick)"),
    "pull-off": ("D", "stretch over sigma at which contacts break off (laws that stick)"),
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="ensemble file; fastest with kept moments")
    grading = parser.add_mutually_exclusive_group()
    grading.add_argument(
        "--gamma", type=float, metavar="G", help="exponential grading, Eq. (4); 1 is homogeneous"
    )
    grading.add_argument("--grading", type=Path, metavar="TABLE.csv", help="columns s or z, ratio or E_star")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.h5", help="default: FILE.regraded.h5")
    parser.add_argument(
        "--csv", type=Path, metavar="CSV", help="also write the ratios at all separations to this file"
    )
    add_law_options(parser)


def execute(args: argparse.Namespace) -> int:
    """Write the new ensemble and print its ratios to the old one."""
    from mcgw.commands.outputs import HDF5, Output, check_outputs, table_output, write_table
    from mcgw.commands.voice import ALL, news, says, tell_cautions
    from mcgw.ensemble.regrading import regrade, regraded_scene
    from mcgw.formats.table import stacked
    from mcgw.reports.text import ends_in_words, ratio_tables
    from mcgw.scene.files_beside import read_grading
    from mcgw.store.ensembles import open_ensemble
    from mcgw.store.place import finished
    from mcgw.store.saving import save

    table, gamma, law = args.grading, args.gamma, law_of(args)
    if law is None and table is None and gamma is None:
        raise ValueError("regrade: give another grading (--gamma, --grading) or contact law (--law)")
    old = open_ensemble(args.file)
    grading: Any = read_grading(table, old.scene.surface) if table else None
    if gamma is not None:
        from analytic import Exponential

        grading = Exponential(gamma)
    path = args.output or args.file.with_suffix(".regraded.h5")
    inputs = [args.file, table] if table else [args.file]
    check_outputs([Output(path, HDF5, grows=True), *table_output(args.csv)], inputs=inputs)
    asked = regraded_scene(old, grading, law)
    finished(path, asked, old.sampler)
    new = save(regrade(old, grading, law=law), path)
    ratios = ratio_tables(new, old)
    news(f"{path}: {new.n_surfaces} surfaces, the same as in {args.file}")
    if says(ALL):
        news(*(ratio.rows().text() for ratio in ratios.values()))
    else:
        news(*(ends_in_words(name, ratio) for name, ratio in ratios.items()))
    news(f"next: mcgw compare {path}")
    tell_cautions(asked, f"mcgw show {path}")
    write_table(args.csv, lambda: stacked(ratios, "quantity"))
    return 0


def add_law_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a contact law; their values are checked as in a scene file."""
    group = parser.add_argument_group("another contact law, and its constants as in a scene file")
    group.add_argument("--law", metavar="LAW", help="its name, such as kogut-etsion")
    for name, (metavar, what) in _CONSTANTS.items():
        group.add_argument(f"--{name}", metavar=metavar, help=what)


def law_of(args: argparse.Namespace) -> "ContactLaw | None":
    """The requested law, or None.

    Raises
    ------
    ValueError
        If a constant is given without a law.
    SceneError
        If a value is wrong; the line names the key.
    """
    from mcgw.scene.laws import read_law

    given = {key: getattr(args, key) for key in (name.replace("-", "_") for name in _CONSTANTS)}
    constants = {key: _plain(value) for key, value in given.items() if value is not None}
    if args.law is None:
        if constants:
            key = next(iter(constants)).replace("_", "-")
            raise ValueError(f"--{key}: belongs to a contact law; give --law too")
        return None
    return read_law({"law": args.law, **constants})


def _plain(text: str) -> Any:
    """A number if the text is one, otherwise the text with its unit."""
    with suppress(ValueError):
        return float(text)
    return text
