"""From a scene to an ensemble in memory."""

from dataclasses import replace
from time import monotonic
from typing import Any

from mcgw.ensemble.drawing import blocks, kept, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import without_rule
from mcgw.ensemble.results import MemoryResults, joined
from mcgw.machine.memory import check_memory
from mcgw.machine.progress import Progress, told
from mcgw.sampling.samplers import sampler_of
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
    sampler = sampler_of(scene)
    if scene.keep == "statistics":
        from mcgw.ensemble.summarising import simulated  # for those scenes alone

        with use_threads(threads), told(progress, "surfaces") as tell:
            return simulated(scene, sampler, until, tell)
    if until is None:
        _check_memory(scene, scene.n_surfaces)
    parts, drawn = [], 0
    with use_threads(threads), told(progress, "surfaces") as tell:
        tell(0, scene.n_surfaces)
        for block in blocks(scene, sampler):
            parts.append(kept(scene, block))
            n = len(parts[-1][scene.quantities[0]])
            _check_memory(scene, n)  # how many there is time for is not known beforehand
            drawn += n
            tell(drawn, scene.n_surfaces)
            if until is not None and monotonic() > until:
                break
    if drawn != scene.n_surfaces or isinstance(scene.n_surfaces, LeftOut):
        scene = replace(scene, n_surfaces=drawn)
    return Ensemble(scene, sampler.name, MemoryResults(joined(parts)))


def _check_memory(scene: Scene, n_surfaces: int) -> None:
    quantities, separations = len(scene.quantities), len(scene.separations)
    what = f"ensemble.n_surfaces = {n_surfaces}: {quantities} quantities at {separations} separations"
    check_memory(what, 2 * 8 * n_surfaces * scene.width)  # the blocks, and all of them joined
