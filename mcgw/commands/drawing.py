"""Surfaces in files: ``mcgw run``, ``mcgw sweep``, and ``mcgw merge`` of what jobs have drawn of either."""

import logging
import warnings
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from mcgw.commands import kinds
from mcgw.commands.outputs import details, news, notes

if TYPE_CHECKING:
    from mcgw.ensemble.forecast import Forecast
    from mcgw.scene.scene import Scene

_LONG = 60.0  # seconds; longer runs state their duration beforehand


@contextmanager
def drawing(
    threads: int | None, jobs: int | None, dask: str | None, shard: str | None
) -> Iterator[dict[str, Any]]:
    """Yield the arguments of `mcgw.run` and `mcgw.sweep` that say how.

    Libraries log nothing meanwhile: mcgw itself reports a lost worker or scheduler, in one line.
    """
    from mcgw.jobs.executors import Jobs as Processes, dask_executor

    chosen: AbstractContextManager[Any] = nullcontext()
    if jobs is not None:
        chosen = Processes(jobs)
    elif dask is not None:
        chosen = dask_executor(dask)
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with chosen as executor:
            yield {"threads": threads, **({"executor": executor} if shard is None else {"shard": shard})}
    finally:
        logging.disable(before)


def share_done(shard: str, path: object, left: int) -> str:
    """Say that a share is done and what remains."""
    then = f"{left} surfaces are still missing" if left else f"all are done: mcgw merge {path}"
    return f"{path}.parts: shard {shard} is done; {then}"


def run(
    scene: Annotated["Scene", kinds.scene_file(cautious="full")],
    *,
    output: Annotated[Path, kinds.file_out("an ensemble", "out/{}.h5", grows=True)],
    threads: kinds.Threads = None,
    jobs: kinds.Jobs = None,
    dask: kinds.Dask = None,
    shard: kinds.Share = None,
) -> None:
    """Simulate a scene: draw its surfaces and store load, area, ... in HDF5; resumes where it stopped.

    The first run on a machine compiles the loops that it needs, which takes about 12 s; mcgw warm compiles
    all of them in advance.

    output (FILE.h5): the ensemble

    example: mcgw run runs/demo.toml -o demo.h5
    """
    from mcgw.ensemble.forecast import after, forecast
    from mcgw.formats.table import with_error
    from mcgw.jobs.running import run as drawn
    from mcgw.machine.threads import THREADS

    ruled = scene.rel_err is not None or scene.max_seconds is not None
    with warnings.catch_warnings(), drawing(threads, jobs, dask, shard) as how:
        warnings.filterwarnings("ignore", ".* n_surfaces allows")  # said as a note, or by the forecast
        if threads is not None and threads > THREADS.get():
            notes(f"--threads {threads}: this machine has {THREADS.get()}; using all of them")
        _tell_before(scene, forecast(scene), ruled=ruled, shared=shard is not None)
        ensemble = drawn(scene, output, **how)
    if shard is not None:
        return news(share_done(shard, output, ensemble))
    drawn_as, found = ensemble.scene, []
    k = drawn_as.separations.index(drawn_as.lowest)
    for name in (name for name in ("load", "area") if name in drawn_as.quantities):
        value = with_error(ensemble.mean(name)[k], ensemble.stderr(name)[k])
        found.append(f"{name} {value} {drawn_as.quantity(name).unit}")
    made = f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}"
    result = f"; {', '.join(found)} at d/sigma = {drawn_as.lowest:g}" if found else ""
    news(f"{output}: {made}{result}", *(after(ensemble, scene) if ruled else ()))
    known = scene.validity()
    news(known.verdict)
    details(*filter(None, [known.details]))
    return news(f"next: mcgw compare {output}")


def _tell_before(scene: "Scene", expected: "Forecast", *, ruled: bool, shared: bool) -> None:
    """Say what a rule needs, or how long the run will take, if more than a minute."""
    from mcgw.ensemble.drawing import seconds_per_surface
    from mcgw.ensemble.forecast import before, in_words, rough_seconds
    from mcgw.sampling.samplers import sampler_of

    sampler, m = sampler_of(scene), scene.n_surfaces
    if not ruled and (seconds := rough_seconds(scene, m)) >= _LONG:
        notes(
            f"{m:g} surfaces of {scene.n_asperities:g} asperities: about {in_words(seconds)} on this machine "
            f"({sampler.draws * m:.2g} draws); Ctrl-C keeps finished work; details: mcgw show --plan"
        )
    if shared:
        notes(*filter(None, [expected.shortfall]))
    elif ruled:
        news(f"forecast: {before(expected, seconds_per_surface(scene, sampler))}")


def _axes(given: list[str], option: str, _call: kinds.Call) -> dict[str, list[Any]]:
    """Return lists of values by key."""
    axes: dict[str, list[Any]] = {}
    for text in given:
        key, words = kinds.pair(text, option, "KEY=VALUES, such as grading.gamma=0.2:2:10 or =0.5,1,2")
        parts = [kinds.as_value(part) for part in words.split(":")]
        if len(parts) == 3 and not any(isinstance(part, str) for part in parts):
            axes[key] = kinds.ranged(words, f"{option} {key}")
        else:
            axes[key] = [kinds.as_value(word) for word in words.split(",")]
    return axes


def sweep(
    scene: kinds.Cautioned,
    *,
    over: Annotated[dict[str, list[Any]], kinds.Kind(read=_axes)],
    zip: bool = False,  # noqa: A002
    plan: bool = False,
    output: Annotated[Path, kinds.file_out("an ensemble", "out/{}.sweep.h5", grows=True, dry="plan")],
    threads: kinds.Threads = None,
    jobs: kinds.Jobs = None,
    dask: kinds.Dask = None,
    shard: kinds.Share = None,
) -> None:
    """Draw many scenes at once on the same surfaces: means, deviations, paired ratios; resumes.

    scene (SCENE): TOML file with what all points have in common
    over (KEY=VALUES): a key of the scene and its values, such as ensemble.n_asperities=1e4,1e5 or
        grading.gamma=0.2:2:10 (A:B:N for N of them from A to B, at equal steps); repeat for more axes
    zip: combine the first values of all keys into one point, and so on
    plan: print what would be drawn and how long it takes, without drawing
    output (FILE.h5): the sweep

    example: mcgw sweep runs/demo.toml --over grading.gamma=0.2:2:10 -o gamma.h5
    """
    from mcgw.jobs.sweeping import sweep as drawn
    from mcgw.reports.text import ratios_in_words
    from mcgw.sweeps.axes import axes_of
    from mcgw.sweeps.points import Points, sweep_plan_text

    if plan:
        return print(sweep_plan_text(Points.of(scene, axes_of(over, zipped=zip))))
    with drawing(threads, jobs, dask, shard) as how:
        found = drawn(scene, over, zipped=zip, path=output, **how)
    if shard is not None:
        return news(share_done(shard, output, found))
    ratios = ratios_in_words(found)
    news(f"{output}: {found.axes.size} scenes, seed {scene.seed}", *ratios[:1])
    details(*ratios[1:])
    news(f"next: mcgw compare {output}")
    return details(found)


def merge(file: Annotated[Path, kinds.file_out("an ensemble", grows=True)]) -> None:
    """Merge the blocks of a run or sweep that several jobs drew (--shard i/n) into one file.

    file (FILE): the file to make, as given to run -o

    example: mcgw merge demo.h5
    """
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.formats.files import state_of
    from mcgw.jobs.blocks import merge as merged

    before = state_of(file)
    found = merged(file)
    done = "was finished before, " if state_of(file) == before else ""
    if isinstance(found, Ensemble):
        scene, made = found.scene, f"{found.n_surfaces} surfaces"
    else:
        scene, made = found.scenes[0], f"{found.axes.size} scenes"
    news(f"{file}: {done}{made}, seed {scene.seed}", f"next: mcgw compare {file}")
