"""Before the first run: ``mcgw init``, ``mcgw warm`` and ``mcgw completion``."""

from pathlib import Path
from typing import Annotated, Any, Literal

from mcgw.commands.kinds import Kind
from mcgw.commands.outputs import Output, check_outputs, news

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


_WORDS = "".join(f"; {name}: {what}" for name, what in PRESETS.items())
Preset = Annotated[str, Kind(choices=tuple(PRESETS), words=_WORDS)]


def init(preset: Preset = "demo", *, output: Path | None = None, schema: bool = False) -> None:
    """Write a commented scene to start from.

    preset (PRESET): its name
    output (SCENE): default: PRESET.toml in the current folder
    schema: also write scene.schema.json, with which editors complete keys

    example: mcgw init coating -o mine.toml && mcgw run mine.toml -o mine.h5
    """
    from importlib.resources import files

    from mcgw.formats.files import together, write_whole

    scene = (files("mcgw.scene") / "presets" / f"{preset}.toml").read_bytes()
    path = output or Path(f"{preset}.toml")
    beside, known = path.with_name(SCHEMA), (files("mcgw.scene") / SCHEMA).read_bytes()
    check_outputs([Output(path, "a scene")])
    if path.exists():
        raise ValueError(f"{path}: already exists; give another name with -o")
    news(f"{path}: {PRESETS[preset]}")
    with together():
        if schema:
            scene = f"#:schema ./{SCHEMA}\n".encode() + scene
            if not beside.exists():
                write_whole(beside, known, expected=None)
            elif beside.read_bytes() != known:
                raise ValueError(f"{beside}: already exists, from another version; remove it")
        write_whole(path, scene, expected=None)
    if schema:
        news(f"{beside}: with it editors complete and check {path.name}")
    news(f"next: mcgw run {path} -o {path.with_suffix('.h5')}")


def warm() -> None:
    """Compile all loops now, once for this machine, so that later runs only load them.

    example: mcgw warm
    """
    import os

    from analytic import KogutEtsion, Nayak, RandomCurvature
    from mcgw.ensemble.simulation import simulate
    from mcgw.machine.compiling import loops_folder
    from mcgw.machine.process import steps
    from mcgw.maps.envelope import envelope, hidden_summits
    from mcgw.maps.fitting import fit
    from mcgw.maps.synthetic import asperities_of
    from mcgw.scene.scene import Scene
    from mcgw.scene.surface import Surface

    surface = Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    drawn = {"n_surfaces": 20, "n_asperities": 3000}
    scene = Scene(surface, separations=[0.0, 0.5, 2.0], ensemble=drawn, seed=1)
    yielding: dict[str, Any] = {"law": KogutEtsion(critical=0.1)}
    radii: dict[str, Any] = {"heights": Nayak(4.0), "summits": RandomCurvature(4.0)}
    changes = (  # laws, samplers, crowds, statistics, radii
        *(yielding, yielding | {"unload_from": 0.0}, yielding | {"sampler": "tail"}),
        *({"sampler": "direct"}, {"count": "poisson"}, {"keep": "statistics"}),
        *({"sampler": "aggregate", "n_asperities": 10**6}, radii | {"sampler": "tail"}, radii),
    )
    for each in steps(changes, "scenes"):
        simulate(scene.replace(**each))
    field = asperities_of(scene, 0)
    for periodic in (False, True):
        fit(envelope(field, (64, 64), periodic=periodic), cutoff=None)
        hidden_summits(field, periodic=periodic)
    news(f"all loops are compiled; cached in {os.environ.get('NUMBA_CACHE_DIR') or loops_folder()}")


def completion(shell: Literal["bash", "zsh", "fish"]) -> None:
    """Print a shell script that completes commands, options and files.

    shell (SHELL): bash, zsh, fish

    example: mcgw completion bash
    """
    from argparse import _SubParsersAction
    from pathlib import Path

    from mcgw.commands.declared import parser_of
    from mcgw.errors import extra

    try:
        import shtab  # an extra
    except ImportError:
        raise ValueError(f"shtab is not installed: {extra('completion')}") from None
    whole = parser_of()
    (commands,) = (x for x in whole._actions if isinstance(x, _SubParsersAction))
    for parser in (whole, *commands.choices.values()):
        for action in parser._actions:
            if action.type is Path:
                action.complete = shtab.FILE
    print(shtab.complete(whole, shell))
