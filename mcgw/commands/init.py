"""``mcgw init``: a commented scene to start from."""

import argparse
from pathlib import Path

HELP = "write a commented scene to start from"
EXAMPLE = "mcgw init coating -o mine.toml && mcgw run mine.toml -o mine.h5"

# By name: what it is.
PRESETS = {
    "demo": "bead-blasted aluminium with stiffened tips",
    "aluminium": "bead-blasted aluminium of Greenwood and Williamson, homogeneous",
    "metal": "the same where asperities yield, with its way back",
    "spectral": "a Gaussian surface by its spectrum, each summit with its own radius",
    "coating": "a graded hard coating",
    "degradation": "tips softened by chemical attack",
    "nanoindentation": "a table of measured moduli",
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    listed = "; ".join(f"{name}: {what}" for name, what in PRESETS.items())
    parser.add_argument(
        "preset", nargs="?", default="demo", choices=PRESETS, metavar="PRESET", help=f"{listed} default: demo"
    )
    parser.add_argument("-o", "--output", type=Path, metavar="SCENE", help="default: PRESET.toml here")


def execute(args: argparse.Namespace) -> int:
    """Write the scene, never over another file."""
    from importlib.resources import files

    from mcgw.commands.outputs import TOML, Output, check_outputs
    from mcgw.formats.files import write_whole

    text = (files("mcgw.scene") / "presets" / f"{args.preset}.toml").read_bytes()
    path = args.output or Path(f"{args.preset}.toml")
    check_outputs([Output(path, TOML)])
    try:
        write_whole(path, [text], expected=None)
    except FileExistsError:
        raise ValueError(f"{path}: is already there; give another name with -o") from None
    print(f"{path}: {PRESETS[args.preset]}\nnext: mcgw run {path} -o {path.with_suffix('.h5')}")
    return 0
