"""``mcgw init``: a commented scene to start from."""

import argparse
from pathlib import Path

HELP = "write a commented scene to start from"
EXAMPLE = "mcgw init coating -o mine.toml && mcgw run mine.toml -o mine.h5"

SCHEMA = "scene.schema.json"

# Name and description.
PRESETS = {
    "demo": "lapped silicon carbide with stiffened tips, which stays elastic",
    "aluminium": "bead-blasted aluminium of Greenwood and Williamson, whose asperities yield",
    "metal": "bead-blasted aluminium whose asperities yield, loaded and unloaded",
    "spectral": "a Gaussian surface given by its spectrum, each summit with its own radius",
    "coating": "a graded hard coating",
    "degradation": "glass whose tips were softened by chemical attack",
    "nanoindentation": "a table of measured moduli",
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    listed = "; ".join(f"{name}: {what}" for name, what in PRESETS.items())
    parser.add_argument(
        "preset",
        nargs="?",
        default="demo",
        choices=tuple(PRESETS),
        metavar="PRESET",
        help=f"{listed}; default: demo",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="SCENE", help="default: PRESET.toml in the current folder"
    )
    parser.add_argument(
        "--schema", action="store_true", help=f"also write {SCHEMA}, with which editors complete keys"
    )


def execute(args: argparse.Namespace) -> int:
    """Write the scene, never over another file."""
    from importlib.resources import files

    from mcgw.commands.outputs import TOML, Output, check_outputs
    from mcgw.commands.voice import news
    from mcgw.formats.files import write_whole

    text = (files("mcgw.scene") / "presets" / f"{args.preset}.toml").read_bytes()
    path = args.output or Path(f"{args.preset}.toml")
    check_outputs([Output(path, TOML)])
    if args.schema:
        if path.exists():
            raise _is_there(path)
        _write_schema(path.with_name(SCHEMA))
        text = f"#:schema ./{SCHEMA}\n".encode() + text
    try:
        write_whole(path, [text], expected=None)
    except FileExistsError:
        raise _is_there(path) from None
    news(f"{path}: {PRESETS[args.preset]}")
    if args.schema:
        news(f"{path.with_name(SCHEMA)}: with it editors complete and check {path.name}")
    news(f"next: mcgw run {path} -o {path.with_suffix('.h5')}")
    return 0


def _is_there(path: Path) -> ValueError:
    return ValueError(f"{path}: already exists; give another name with -o")


def _write_schema(path: Path) -> None:
    """Write the JSON Schema of scenes, unless the same one is there already.

    Raises
    ------
    ValueError
        If another file has its name.
    """
    from importlib.resources import files

    from mcgw.formats.files import write_whole

    schema = (files("mcgw.scene") / SCHEMA).read_bytes()
    try:
        write_whole(path, [schema], expected=None)
    except FileExistsError:
        if path.read_bytes() != schema:
            raise ValueError(f"{path}: already exists, from another version; remove it") from None
