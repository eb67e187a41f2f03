"""A run that ends by its stop rule: extended, look by look, until every mean is known well enough."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import Any

from mcgw.engines import Engine
from mcgw.ensemble import Ensemble
from mcgw.forecast import forecast
from mcgw.running import run
from mcgw.scene import Scene
from mcgw.stopping import Running, checkpoints, decide
from mcgw.store.ensembles import open_ensemble

__all__ = ["run_until_known"]

_EARLY = 0.9  # of the forecast: where the first look is taken
_ROWS = 4096  # surfaces read at a time


def run_until_known(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    engine: Engine | None = None,
    progress: Callable[[int], Any] | None = None,
) -> Ensemble:
    """Draw the ensemble of a scene with a stop rule into a file, going on where an earlier run stopped.

    Parameters
    ----------
    scene : Scene
        With `rel_err` or `max_seconds`; `n_surfaces` is the limit.
    path : str or Path
        The file. One that holds this scene already, to a wider error, is extended.
    threads, engine, progress
        As for `mcgw.running.run`.

    Returns
    -------
    Ensemble
        That reads from the file; its scene tells how many surfaces there are, and has no rule.

    Raises
    ------
    StoreError, RunError
        As for `mcgw.running.run`.
    """
    path, started = Path(path), monotonic()
    fixed = replace(scene, rel_err=None, max_seconds=None)
    seen = Running.empty(len(scene.quantities) * len(scene.separations))
    for n in _looks(scene, path):
        ensemble = run(replace(fixed, n_surfaces=n), path, threads=threads, engine=engine, progress=progress)
        if scene.max_seconds is not None and monotonic() - started > scene.max_seconds:
            break
        if scene.rel_err is not None:
            seen = _add(scene, seen, ensemble)
            if not decide(scene, seen).go_on:
                break
    return ensemble


def _looks(scene: Scene, path: Path) -> Iterator[int]:
    """Numbers of surfaces at which one looks: what there is, then from shortly before the forecast on."""
    held = min(open_ensemble(path).n_surfaces, scene.n_surfaces) if path.is_file() else 0
    if held:
        yield held
    first = _EARLY * forecast(scene).surfaces if scene.rel_err is not None else 0
    last = held
    for n in checkpoints(scene.n_surfaces):
        enough = n > held and n >= first and (scene.rel_err is not None or n >= 2 * last)
        if enough or n == scene.n_surfaces > held:
            yield n
            last = n


def _add(scene: Scene, seen: Running, ensemble: Ensemble) -> Running:
    """Take in the surfaces that are new since the last look."""
    for start in range(seen.n + len(seen.rest), ensemble.n_surfaces, _ROWS):
        stop = min(start + _ROWS, ensemble.n_surfaces)
        seen = seen.add(scene, {name: ensemble.sums.read(name, start, stop) for name in scene.quantities})
    return seen
