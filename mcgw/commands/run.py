"""``mcgw run``: draw an ensemble into a file."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mcgw.commands.kinds import file_out, scene_file
from mcgw.commands.options import Dask, Jobs, Share, Threads, drawing, share_done
from mcgw.commands.outputs import HDF5
from mcgw.commands.voice import details, news, notes

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.ensemble.forecast import Forecast
    from mcgw.scene.scene import Scene

_LONG = 60.0  # seconds; longer runs state their duration beforehand


def run(
    scene: Annotated["Scene", scene_file(cautious="full")],
    *,
    output: Annotated[Path, file_out(HDF5, "out/{}.h5", grows=True)],
    threads: Threads = None,
    jobs: Jobs = None,
    dask: Dask = None,
    shard: Share = None,
) -> None:
    """Simulate a scene: draw its surfaces and store load, area, ... in HDF5; resumes where it stopped.

    The first run on a machine compiles the loops that it needs, which takes about 12 s; mcgw warm compiles
    all of them in advance.

    Parameters
    ----------
    output : FILE.h5
        the ensemble

    Examples
    --------
    mcgw run runs/demo.toml -o demo.h5
    """
    from numba import get_num_threads

    from mcgw.ensemble.forecast import after, forecast
    from mcgw.jobs.running import run as drawn

    ruled = scene.rel_err is not None or scene.max_seconds is not None
    with warnings.catch_warnings(), drawing(threads, jobs, dask, shard) as how:
        warnings.filterwarnings("ignore", ".* n_surfaces allows")  # said as a note, or by the forecast
        if threads is not None and threads > get_num_threads():
            notes(f"--threads {threads}: this machine has {get_num_threads()}; using all of them")
        _tell_before(scene, forecast(scene), ruled=ruled, shared=shard is not None)
        ensemble = drawn(scene, output, **how)
    if shard is not None:
        return news(share_done(shard, output, ensemble))
    made = f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}"
    news(f"{output}: {made}{_result(ensemble)}", *(after(ensemble, scene) if ruled else ()))
    known = scene.validity()
    news(known.verdict)
    details(*filter(None, [known.details]))
    return news(f"next: mcgw compare {output}")


def _result(ensemble: "Ensemble") -> str:
    """Load and area at the smallest separation."""
    from mcgw.formats.table import with_error

    scene = ensemble.scene
    k = scene.separations.index(scene.lowest)
    found = [
        f"{name} {with_error(ensemble.mean(name)[k], ensemble.stderr(name)[k])} {scene.quantity(name).unit}"
        for name in ("load", "area")
        if name in scene.quantities
    ]
    return f"; {', '.join(found)} at d/sigma = {scene.lowest:g}" if found else ""


def _tell_before(scene: "Scene", expected: "Forecast", *, ruled: bool, shared: bool) -> None:
    """Say what a rule needs, or how long the run will take, if more than a minute."""
    from mcgw.ensemble.drawing import in_words, seconds_for, seconds_per_surface
    from mcgw.ensemble.forecast import before
    from mcgw.sampling.samplers import sampler_of

    sampler, m = sampler_of(scene), scene.n_surfaces
    if not ruled and (seconds := seconds_for(scene, sampler, m, at_least=_LONG / 4)) >= _LONG:
        notes(
            f"{m:g} surfaces of {scene.n_asperities:g} asperities: about {in_words(seconds)} on this machine "
            f"({sampler.draws * m:.2g} draws); Ctrl-C keeps finished work; details: mcgw show --plan"
        )
    if shared:
        notes(*filter(None, [expected.shortfall]))
    elif ruled:
        news(f"forecast: {before(expected, seconds_per_surface(scene, sampler))}")
