"""``mcgw init``: a commented scene to start from."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import Kind
from mcgw.commands.outputs import TOML, Output, check_outputs
from mcgw.commands.voice import news

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


_PRESET = Kind(choices=tuple(PRESETS), words="".join(f"; {name}: {what}" for name, what in PRESETS.items()))


def init(
    preset: Annotated[str, _PRESET] = "demo", *, output: Path | None = None, schema: bool = False
) -> None:
    """Write a commented scene to start from.

    Parameters
    ----------
    preset : PRESET
        its name
    output : SCENE
        default: PRESET.toml in the current folder
    schema
        also write scene.schema.json, with which editors complete keys

    Examples
    --------
    mcgw init coating -o mine.toml && mcgw run mine.toml -o mine.h5
    """
    from importlib.resources import files

    from mcgw.formats.files import together, write_whole

    scene = (files("mcgw.scene") / "presets" / f"{preset}.toml").read_bytes()
    path = output or Path(f"{preset}.toml")
    beside, known = path.with_name(SCHEMA), (files("mcgw.scene") / SCHEMA).read_bytes()
    check_outputs([Output(path, TOML)])
    if path.exists():
        raise ValueError(f"{path}: already exists; give another name with -o")
    news(f"{path}: {PRESETS[preset]}")
    with together():
        if schema:
            scene = f"#:schema ./{SCHEMA}\n".encode() + scene
            if not beside.exists():
                write_whole(beside, [known], expected=None)
            elif beside.read_bytes() != known:
                raise ValueError(f"{beside}: already exists, from another version; remove it")
        write_whole(path, [scene], expected=None)
    if schema:
        news(f"{beside}: with it editors complete and check {path.name}")
    news(f"next: mcgw run {path} -o {path.with_suffix('.h5')}")
