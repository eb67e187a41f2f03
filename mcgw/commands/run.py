"""``mcgw run``: draw an ensemble into a file."""

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.commands.options import add_drawing_options, add_set_option, changes_of, drawing, tell_shard

if TYPE_CHECKING:
    from mcgw.scene.scene import Scene

HELP = "simulate a scene: draw its surfaces and store load, area, ... in HDF5; resumes where it stopped"
EXAMPLE = "mcgw run runs/demo.toml -o demo.h5"
_LONG = 60.0  # seconds; longer runs state their duration beforehand


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.description = (
        f"{parser.description or ''} The first run on a machine compiles the loops that it needs, which "
        "takes about 12 s; mcgw warm compiles all of them in advance."
    )
    parser.add_argument("scene", type=Path, metavar="SCENE", help="TOML file, SI units")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE.h5", help="default: out/NAME.h5 beside the scene"
    )
    add_drawing_options(parser)
    add_set_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Run and print the path of the file."""
    with warnings.catch_warnings():  # a limit that is too low is reported as a note, or by the forecast
        warnings.filterwarnings("ignore", ".* max_surfaces allows")
        return _execute(args)


def _execute(args: argparse.Namespace) -> int:
    from mcgw.commands.outputs import HDF5, Output, check_outputs
    from mcgw.commands.voice import details, look_next, news, notes, tell_cautions
    from mcgw.ensemble.forecast import forecast
    from mcgw.jobs.driver import part_of
    from mcgw.jobs.running import run
    from mcgw.scene.scene_file import files_of, load_scene
    from mcgw.store.place import recorded_seed

    path = args.output or args.scene.parent / "out" / f"{args.scene.stem}.h5"
    if args.shard is not None:
        part_of(args.shard)  # checked before anything is read
    scene = load_scene(args.scene, changes=changes_of(args), seed=lambda: recorded_seed(path))
    check_outputs([Output(path, HDF5, grows=True)], inputs=files_of(args.scene))
    expected = forecast(scene)
    short = [expected.shortfall] if args.shard and expected.shortfall else []
    ruled = scene.rel_err is not None or scene.max_seconds is not None
    with drawing(args) as how:
        notes(*_of_threads(args.threads), *_of_time(scene), *short)
        if ruled and not args.shard:
            from mcgw.ensemble.drawing import seconds_per_surface
            from mcgw.ensemble.forecast import before
            from mcgw.sampling.samplers import sampler_of

            news(f"forecast: {before(expected, seconds_per_surface(scene, sampler_of(scene)))}")
        ensemble = run(scene, path, **how)
    if args.shard:
        return tell_shard(args.shard, path, ensemble)
    news(f"{path}: {ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}")
    if ruled:
        from mcgw.ensemble.forecast import after

        news(*after(ensemble, scene))
    known = scene.validity()
    news(known.verdict)
    details(*filter(None, [known.details]))
    look_next(path)
    tell_cautions(scene)
    return 0


def _of_threads(threads: int | None) -> list[str]:
    from numba import get_num_threads

    if threads is None or threads <= get_num_threads():
        return []
    return [f"--threads {threads}: this machine has {get_num_threads()}; using all of them"]


def _of_time(scene: "Scene") -> list[str]:
    """Say how long the run will take, if more than a minute."""
    from mcgw.ensemble.drawing import in_words, seconds_for
    from mcgw.sampling.samplers import sampler_of

    if scene.rel_err is not None or scene.max_seconds is not None:
        return []  # these print a forecast or have a known end
    sampler, m = sampler_of(scene), scene.n_surfaces
    seconds = seconds_for(scene, sampler, m, at_least=_LONG / 4)
    if seconds < _LONG:
        return []
    drawn = sampler.draws * m
    return [
        f"{m:g} surfaces of {scene.n_asperities:g} asperities: about {in_words(seconds)} on this machine "
        f"({drawn:.2g} draws); Ctrl-C keeps finished work; details: mcgw show --plan"
    ]
