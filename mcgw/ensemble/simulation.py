"""From a scene to an ensemble in memory."""

from dataclasses import replace
from time import monotonic
from typing import Any

from mcgw.ensemble.drawing import drawn, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import without_rule
from mcgw.ensemble.reducers import reducer_of
from mcgw.machine.progress import Progress, told
from mcgw.scene.scene import LeftOut, Scene
from mcgw.scene.storable import storable
from mcgw.scene.wrong_object import check_object

__all__ = ["simulate"]


def simulate(
    scene: Scene, *, threads: int | None = None, progress: Progress = None, **changes: Any
) -> Ensemble:
    """Draw the ensemble of a scene in memory.

    Parameters
    ----------
    scene : Scene
        What is asked.
    threads : int, optional
        Default: all there are. The result is the same, bit by bit, for any number.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces after each block.
    **changes
        Fields of the scene that have other values: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        With arrays of shape (surfaces, separations). Where `rel_err` or `max_seconds` decided how many
        surfaces, its scene says their number instead: run again, it gives the same. A grading that is a
        Python function is there as its series.

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
    reducer, done_before = reducer_of(scene), 0
    sampler = reducer.sampler.name
    reducer.check(scene.n_surfaces if until is None else 0)

    def go_on(done: int) -> bool:
        nonlocal done_before
        tell(done, scene.n_surfaces)
        if until is None:
            return True
        reducer.check(done - done_before)  # how many there is time for is not known beforehand
        done_before = done
        return monotonic() <= until

    with use_threads(threads), told(progress, "surfaces") as tell:
        tell(0, scene.n_surfaces)
        held = drawn(reducer, go_on)
    n = held.rows()
    if n != scene.n_surfaces or isinstance(scene.n_surfaces, LeftOut):
        scene = replace(scene, n_surfaces=n)
    return Ensemble(scene, sampler, held)
