"""``mcgw.run``: from a scene to its file, at once or in blocks: begin, resume, extend, share."""

from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path
from time import monotonic, perf_counter
from typing import Any, overload

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import forecast, without_rule
from mcgw.errors import RunError, in_one_line
from mcgw.jobs.blocks import Done, in_blocks
from mcgw.machine.process import Progress, Signals, heed_signals, told
from mcgw.sampling.block import GROUP
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene
from mcgw.store.ensembles import open_ensemble
from mcgw.store.ownership import locked
from mcgw.store.place import as_recorded, check_room, drop_leftovers, finished, put, tidy
from mcgw.store.run_plan import RECORD, Plan, Span


@overload
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = ...,
    executor: Executor | None = ...,
    shard: None = ...,
    progress: Progress = ...,
    **changes: Any,
) -> Ensemble: ...
@overload
def run(scene: Scene, path: str | Path, *, shard: str, **others: Any) -> int: ...
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    shard: str | None = None,
    progress: Progress = None,
    **changes: Any,
) -> Ensemble | int:
    """Draw the ensemble of a scene into a file, or resume an earlier run.

    The same call again resumes, or extends the file if the scene now has more surfaces; if the scene has
    no seed, it uses that of the file.

    Parameters
    ----------
    scene : Scene
        What to simulate; `n_surfaces` is the total, or with `rel_err` or `max_seconds` the most.
    path : str or Path
        The file; it appears when it is complete. Until then, blocks lie in ``FILE.parts/``.
    threads : int, optional
        Of this process. Default: all cores. The data are the same for any number.
    executor : concurrent.futures.Executor, optional
        What draws the blocks in place of this process, one thread a block: a pool of processes or threads,
        that of a dask client (``client.get_executor()``) or of ``mpi4py.futures``. It stays open.
    shard : str, optional
        "2/8": draw only the second of eight shares, as one of eight jobs; then `mcgw.merge`.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        Reads from the file; its scene states how many surfaces `rel_err` or `max_seconds` made. With
        `shard`: the number of surfaces of the whole that are still missing.

    Raises
    ------
    SceneError, TypeError
        As from `mcgw.Scene.replace`.
    ValueError
        If another argument is wrong.
    StoreError
        If the file cannot be written there, or the place belongs to another run.
    RunError
        If the run could not be finished; what is done is kept.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     mcgw.run(scene, f"{folder}/demo.h5").n_surfaces
    ...     mcgw.run(scene, f"{folder}/demo.h5", n_surfaces=30).n_surfaces
    20
    30
    """
    check_object("run", scene, Scene)
    path = Path(path)
    scene = scene.replace(**changes) if changes else scene
    if shard is not None and scene.max_seconds is not None:
        raise ValueError("ensemble.max_seconds: the jobs of a run end at different times; give n_surfaces")
    total = scene.n_surfaces if scene.rel_err is None else forecast(scene).surfaces
    part = share_of(executor, threads, shard)
    with told(progress, "surfaces") as tell:
        scene = as_recorded(scene, path)
        if part and scene.rel_err is not None:
            scene = without_rule(scene)
        started = monotonic()
        ruled = scene.rel_err is not None or scene.max_seconds is not None
        for stage in _stages(scene, path) if ruled else (scene,):
            plan = Plan(stage, path)
            left = make(plan, lambda done: tell(done, total), executor, threads, part)
            if scene.max_seconds is not None and monotonic() - started > scene.max_seconds:
                break
    if part:
        return left
    return Ensemble(plan.scene, plan.sampler, *plan.held([], plan.total))


def _stages(scene: Scene, path: Path) -> Iterator[Scene]:
    """Yield the scene with a number of surfaces in place of its stop rules; growing with `max_seconds`."""
    held = min(open_ensemble(path).n_surfaces, scene.n_surfaces) if path.is_file() else 0
    fixed = without_rule(scene)
    last, n = max(fixed.n_surfaces, held), held or GROUP
    while scene.max_seconds is not None and n < last:
        yield fixed.replace(n_surfaces=n)
        n *= 2
    yield fixed.replace(n_surfaces=last)


def share_of(executor: Any, threads: int | None, shard: str | None) -> tuple[int, int] | None:
    """Check who is to draw, and return the share that is named, as (2, 8) for "2/8"."""
    if threads is not None and threads < 1:
        raise ValueError(f"threads = {threads}: give a whole number >= 1")
    if shard is not None and executor is not None:
        raise ValueError(f"shard = {shard!r}: a share uses threads; leave executor out")
    if not (executor is None or isinstance(executor, Executor)):
        raise ValueError(
            f"executor = {executor!r}: give a concurrent.futures.Executor, such as "
            "ProcessPoolExecutor(8) or client.get_executor() of a dask client"
        )
    if shard is None:
        return None
    number, _, of = str(shard).partition("/")
    if not (number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of)):
        raise ValueError(f"--shard {shard}: give i/n with 1 <= i <= n")
    return int(number), int(of)


def make(
    plan: Plan,
    progress: Done,
    executor: Executor | None,
    threads: int | None,
    part: tuple[int, int] | None,
) -> int:
    """Draw what is missing of a file and make it; or of its blocks a share, for `mcgw.merge` to make it of.

    An executor draws the blocks, or threads of this process: one writes a block while others draw the next.
    Of a share `part` has its number, from 1, and of how many. Returns how many surfaces are then missing of
    the whole.
    """
    if finished(plan) < plan.total:
        check_room(plan)
        if part:
            tidy(plan.path)
        with heed_signals() as signals, locked(plan.folder, shared=part is not None) as new:
            if not (part or new):
                drop_leftovers(plan.path)
            if finished(plan) < plan.total:  # no other process was faster
                several = executor or part or plan.axes or (plan.folder / RECORD).exists()
                try:
                    if not several and plan.total <= plan.reducers[0].rows > 1:
                        return _at_once(plan, threads, progress, signals)
                    return in_blocks(plan, executor, threads, part, progress, signals)
                except OSError as error:
                    raise RunError(
                        f"{in_one_line(error)}; finished blocks are kept in {plan.folder}; once this is "
                        "fixed, the same command resumes"
                    ) from None
    tidy(plan.path)
    progress(sum(one.scene.n_surfaces * one.work for one in plan.reducers))
    return 0


def _at_once(plan: Plan, threads: int | None, progress: Done, signals: Signals) -> int:
    """All surfaces of a scene in this thread, and their file in one step. Only with the lock."""

    def go_on(done: float) -> bool:
        signals.check("nothing was saved, because the run is one block; the same command starts it again")
        progress(done)
        return True

    started = perf_counter()
    progress(0)
    tables = plan.draw(Span(0, plan.total), threads, go_on)
    seconds = perf_counter() - started
    put(plan, lambda: plan.contents([plan.reducers[0].held([tables])], seconds))
    return 0
