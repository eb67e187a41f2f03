"""From a scene to an ensemble in memory."""

from time import monotonic
from typing import Any

from mcgw.ensemble.drawing import reducer_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import without_rule
from mcgw.machine.process import Progress, told
from mcgw.machine.threads import use_threads
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene, storable, with_sampling


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
