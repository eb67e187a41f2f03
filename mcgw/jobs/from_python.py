"""``mcgw.run``: a run as a notebook asks for it."""

from pathlib import Path
from typing import Any, overload

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import forecast
from mcgw.jobs import running
from mcgw.jobs.session import chosen_engine, dashboard_of, part_of
from mcgw.machine.progress import Progress, told
from mcgw.scene.ensemble_section import LeftOut
from mcgw.scene.scene import Scene
from mcgw.scene.wrong_object import check_object
from mcgw.store.place import recorded_seed

__all__ = ["run"]


@overload
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    engine: Any = None,
    shard: None = None,
    progress: Progress = None,
    **changes: Any,
) -> Ensemble: ...
@overload
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    shard: str,
    progress: Progress = None,
    **changes: Any,
) -> int: ...
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    engine: Any = None,
    shard: str | None = None,
    progress: Progress = None,
    **changes: Any,
) -> Ensemble | int:
    """Draw the ensemble of a scene into a file, going on where an earlier run stopped.

    The same call again goes on, or extends the file if the scene now has more surfaces; where nobody gave a
    seed it takes that of the file.

    Parameters
    ----------
    scene : Scene
        What is asked; `n_surfaces` is the total, or with `rel_err` or `max_seconds` the most.
    path : str or Path
        The file; it appears when it is complete. Until then, blocks lie in ``FILE.parts/``.
    threads : int, optional
        Cores: threads, or processes or workers of the engine. Default: all there are. The data are the
        same for any number.
    engine : {"threads", "processes", "dask"}, address, distributed.Client or Engine, optional
        Who draws; an address, as ``"tcp://host:8786"``, is that of a dask scheduler. A client is left open,
        and dask's configuration and logging as they are.
    shard : str, optional
        "2/8": draw only the second of eight shares, as one of eight jobs; then `mcgw.merge`.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces.
    **changes
        Fields of the scene that have other values: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        That reads from the file; its scene says how many surfaces `rel_err` or `max_seconds` made. With
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
    scene = scene.replace(**changes)
    if isinstance(scene.seed, LeftOut) and (recorded := recorded_seed(path)) is not None:
        scene = scene.replace(seed=LeftOut(recorded))
    part = None if shard is None else part_of(shard)
    if part and engine is not None:
        raise ValueError(f"shard = {shard!r}: a share is drawn by threads; leave engine out")
    total = forecast(scene).surfaces if progress else 0
    with (
        chosen_engine(engine, threads) as draws,
        told(progress, "surfaces", dashboard_of(draws)) as tell,
    ):

        def note(done: int) -> None:
            tell(done, total)

        if part:
            return running.run_part(scene, path, part, threads=threads, progress=note)
        return running.run(scene, path, threads=threads, engine=draws, progress=note)
