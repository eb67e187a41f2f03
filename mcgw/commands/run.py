"""``mcgw run``: draw an ensemble into a file."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcgw.scene import Scene

HELP = "simulate a scene: draw its surfaces and store load, area, ... in HDF5"
EXAMPLE = "mcgw run runs/demo.toml -o demo.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("scene", type=Path, metavar="SCENE", help="TOML file, SI units")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE.h5", help="default: out/NAME.h5 beside the scene"
    )
    parser.add_argument("--threads", type=int, metavar="N", help="default: all cores; never changes a bit")


def execute(args: argparse.Namespace) -> int:
    """Run and say where the file is."""
    from tqdm import tqdm

    from mcgw.scene_file import load_scene
    from mcgw.store import run

    scene = load_scene(args.scene)
    path = args.output or args.scene.parent / "out" / f"{args.scene.stem}.h5"
    if scene.rel_err is not None or scene.max_seconds is not None:
        return _until_known(scene, path, args.threads)
    with tqdm(total=scene.n_surfaces, unit=" surfaces", disable=None, leave=False) as bar:
        ensemble = run(scene, path, threads=args.threads, progress=bar.update)
    print(f"{path}: {ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}")
    return 0


def _until_known(scene: "Scene", path: Path, threads: int | None) -> int:
    """Draw until the stop rule is content, and say how well every mean is known."""
    from tqdm import tqdm

    from mcgw.forecast import forecast, seconds_per_surface
    from mcgw.samplers import sampler_of
    from mcgw.simulation import simulate
    from mcgw.stop_report import after, before
    from mcgw.store import save

    expected = forecast(scene)
    print(f"forecast: {before(expected, seconds_per_surface(scene, sampler_of(scene)))}")
    with tqdm(total=expected.surfaces, unit=" surfaces", disable=None, leave=False) as bar:
        ensemble = save(simulate(scene, threads=threads, progress=bar.update), path)
    print(f"{path}: {ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}")
    for line in after(ensemble, scene.rel_err or 1.0):
        print(line)
    return 0
