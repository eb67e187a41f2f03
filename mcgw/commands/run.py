"""``mcgw run``: draw an ensemble into a file."""

import argparse
from pathlib import Path

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
    with tqdm(total=scene.n_surfaces, unit=" surfaces", disable=None, leave=False) as bar:
        ensemble = run(scene, path, threads=args.threads, progress=bar.update)
    print(f"{path}: {ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}")
    return 0
