"""From a scene to an ensemble in memory; and how long that takes, in seconds and in words."""

from time import monotonic, perf_counter
from typing import Any

import numba
import numpy as np

from mcgw.ensemble.drawing import block_size, drawn_blocks, reducer_of, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import without_rule
from mcgw.machine.progress import Progress, told
from mcgw.sampling.block import Source
from mcgw.sampling.expected import expected
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene, storable, with_sampling

_PER_COUNT, _PER_PRODUCT = 4e-8, 2.5e-10  # rough seconds per number and per pair, for statistics
_SHORT = 0.01  # s; times below are given in milliseconds


def simulate(
    scene: Scene, *, threads: int | None = None, progress: Progress = None, **changes: Any
) -> Ensemble:
    """Draw the ensemble of a scene in memory.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    threads : int, optional
        Default: all. The result is the same, bit by bit, for any number.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces after each block.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        With arrays of shape (surfaces, separations). If `rel_err` or `max_seconds` determined the number
        of surfaces, its scene states this number instead, and reproduces them. A Python function as
        grading becomes a series.

    Raises
    ------
    ValueError
        If `threads` is not positive, or the memory is too small (with the size).
    SceneError, TypeError
        As from `mcgw.Scene.replace`.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], seed=1)
    >>> mcgw.simulate(scene, n_surfaces=20).load.shape
    (20, 3)
    """
    check_object("simulate", scene, Scene)
    scene = scene.replace(**changes) if changes else scene
    until = None if scene.max_seconds is None else monotonic() + scene.max_seconds
    scene = storable(scene)
    if scene.rel_err is not None or scene.max_seconds is not None:
        scene = without_rule(scene)
    reducer, n, before, more = reducer_of(scene), scene.n_surfaces, 0.0, True
    reducer.check(n if until is None else 0)

    def go_on(done: float) -> bool:
        nonlocal before, more
        tell(done, n)
        if until is not None:  # how many there is time for is not known beforehand
            reducer.check(int(done - before))
            before, more = done, monotonic() <= until
        return more

    with use_threads(threads), told(progress, "surfaces") as tell:
        tell(0, n)
        starts = range(0, n, reducer.rows)
        held = reducer.held(reducer.tables(k, min(k + reducer.rows, n), go_on) for k in starts if more)
    return Ensemble(with_sampling(scene, n_surfaces=held.rows()), reducer.sampler.name, held)


def seconds_per_surface(scene: Scene, sampler: Source[Any]) -> float:
    """Median wall time of drawing one surface in a block, after a warm-up."""
    size = min(block_size(scene, sampler), 256)
    n = size * numba.get_num_threads() if size > 1 else 1
    list(drawn_blocks(sampler, 0, n, size))
    times = []
    for _ in range(3):
        start = perf_counter()
        list(drawn_blocks(sampler, 0, n, size))
        times.append(perf_counter() - start)
    return float(np.median(times)) / n


def rough_seconds(scene: Scene, surfaces: int) -> float:
    """Estimate the wall time of drawing some surfaces by arithmetic alone, s, within a factor of two."""
    return surfaces * (expected(scene).seconds / numba.get_num_threads() + _for_statistics(scene))


def _for_statistics(scene: Scene) -> float:
    """Rough seconds of a surface of which only statistics are kept."""
    return scene.width * _PER_COUNT + scene.width**2 / 2 * _PER_PRODUCT if scene.keep == "statistics" else 0.0


def in_words(seconds: float) -> str:
    """Return a time as people say it.

    Examples
    --------
    >>> in_words(3e-4), in_words(200), in_words(90_000), in_words(1e9)
    ('0.3 ms', '3.3 min', '25 h', '32 years')
    """
    for size, name in ((3.15576e7, "years"), (86_400 * 3, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / (86_400 if name == 'days' else size):.2g} {name}"
    return f"{1e3 * seconds:.2g} ms" if seconds < _SHORT else f"{seconds:.2g} s"
