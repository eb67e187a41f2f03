"""``mcgw.sweep``: from many scenes to their statistics, in memory or in a file that it resumes."""

from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from mcgw.jobs.running import make, share_of
from mcgw.machine.process import Progress, told
from mcgw.machine.threads import use_threads
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene, storable
from mcgw.store.ensembles import open_sweep
from mcgw.store.place import as_recorded
from mcgw.store.run_plan import Plan

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep

_Over = Mapping[str, Iterable[Any]]


@overload
def sweep(
    scene: Scene,
    over: _Over,
    *,
    zipped: bool = ...,
    path: str | Path | None = ...,
    threads: int | None = ...,
    executor: Executor | None = ...,
    shard: None = ...,
    progress: Progress = ...,
) -> "Sweep": ...
@overload
def sweep(
    scene: Scene, over: _Over, *, zipped: bool = ..., path: str | Path, threads: int | None = ...,
    shard: str, progress: Progress = ...,
) -> int: ...  # fmt: skip
def sweep(
    scene: Scene,
    over: _Over,
    *,
    zipped: bool = False,
    path: str | Path | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    shard: str | None = None,
    progress: Progress = None,
) -> "Sweep | int":
    """Find means and standard deviations of many scenes, which share their surfaces where possible.

    Points whose heights have the same law, number and seed share their surfaces, whatever their surfaces'
    parameters, gradings and contact laws are: these are drawn once, and differences between such points
    have no sampling noise. Where points need other cells of heights, as tables with kinks and laws that
    yield do, all are drawn on cells with the edges of all: there a point drawn alone has other surfaces, else
    the same bits. Of eight exponential gradings or more under Hertz's law only the softest and the stiffest
    are computed, for sums are linear in gamma: the others have the means and deviations of single runs to
    1e-12.

    Parameters
    ----------
    scene : Scene
        What all points have in common, its seed too.
    over : dict of str to sequence
        Keys as in a scene file, as "grading.gamma" or "ensemble.n_asperities", and the values of each as
        there; or a whole table, as "grading", whose values may also be gradings as `mcgw.Table`, or Python
        functions, which are resolved over the heights of `scene`.
    zipped : bool, optional
        The first values of all keys make one point, the second ones another. Default: every value of one key
        goes with every value of all others.
    path : str or Path, optional
        A file for it, which appears when all is drawn (`mcgw.open_sweep`). The same call again draws nothing,
        or resumes where it was interrupted; if the scene has no seed, it uses that of the file.
    threads : int, optional
        Cores: threads, or processes or workers of the executor. Default: all. The result is the
        same, bit by bit, for any number.
    executor : concurrent.futures.Executor, optional
        What draws into the file of `path`, as in `mcgw.run`.
    shard : str, optional
        "2/8": draw only the second of eight shares into the folder beside `path`, as one of eight jobs; then
        `mcgw.merge`.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces, each weighted by what it takes.

    Returns
    -------
    Sweep
        With arrays of the shape of the axes and separations. With `shard`: the number of surfaces of the
        whole that are still missing.

    Raises
    ------
    SceneError
        With the mistakes of all points at once, each with the point it is of.
    StoreError
        If the memory is too small, the file cannot be written there, or the place belongs to something else.
    RunError
        If it was interrupted, with a file; what is done is kept.
    ValueError
        If another argument is wrong.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1)
    >>> sweep = mcgw.sweep(scene, {"grading.gamma": [0.5, 1.0, 2.0], "ensemble.count": ["fixed", "poisson"]})
    >>> sweep.mean("load").shape
    (3, 2, 3)
    >>> alone = mcgw.simulate(sweep.scene((2, 0)))
    >>> bool((alone.mean("load") == sweep.mean("load")[2, 0]).all())
    True
    >>> both = {"ensemble.count": "fixed"}
    >>> stiffer = sweep.difference("load", {"grading.gamma": 2.0, **both}, {"grading.gamma": 1.0, **both})
    >>> stiffer.gain.round()
    array([6., 6., 5.])
    >>> sweep.ratio("load", (2, 0), (1, 0)).ratio.round(2)
    array([1.71, 1.86, 1.93])
    """
    from mcgw.sweeps.axes import axes_of  # of which a run needs nothing
    from mcgw.sweeps.points import Points, weighted

    check_object("sweep", scene, Scene)
    if path is None and not (executor is None and shard is None):
        raise ValueError("executor, shard: they need a file; give path, or leave them out")

    def resolved(grading: Any) -> Any:
        return storable(scene.replace(grading=grading)).grading

    axes = axes_of(over, zipped=zipped, resolve=resolved)
    if path is None:
        with use_threads(threads), told(progress, "surfaces") as tell:
            return Points.of(scene, axes).in_memory(tell)
    path = Path(path)
    scene = as_recorded(scene, path)
    part = share_of(executor, threads, shard)
    with told(progress, "surfaces") as tell:
        plan = Plan(Points.of(scene, axes), path)
        left = make(plan, weighted(plan.reducers, tell), executor, threads, part)
    return left if part else open_sweep(path)
