"""What lies at the place of a file: surfaces, a seed, what the dead left behind; and a new file."""

import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from analytic import CustomLaw, PiecewiseSeries
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Labelled
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import check_output, parts_of, refuse_read_only, remove_stale, state_of, whole_file
from mcgw.machine.process import gibibytes
from mcgw.scene.fields import LeftOut
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene, storable
from mcgw.store.ensembles import described, open_ensemble, verify
from mcgw.store.h5_reading import look
from mcgw.store.h5_writing import write
from mcgw.store.ownership import another, locked
from mcgw.store.run_plan import RECORD, Plan


def recorded_scene(path: Path) -> Scene | None:
    """Scene of the ensemble or run that is at a place, if there is one."""
    if path.is_file():
        return described(path)[1]
    return Plan.open(parts_of(path)).scene if (parts_of(path) / RECORD).is_file() else None


def as_recorded(scene: Scene, path: Path) -> Scene:
    """Return the scene with seed and functions resolved, or as they were when the run at this place began.

    The seed, if nobody gave one; another processor, or another NumPy, may give other last digits to a Python
    function.
    """
    if isinstance(scene.seed, LeftOut) and (there := recorded_scene(path)) is not None:
        scene = scene.replace(seed=LeftOut(there.seed))
    resolved = storable(scene)
    there = None if resolved is scene else recorded_scene(path)
    if there is None:
        return resolved
    mine, before = resolved.grading, there.grading
    if isinstance(mine, PiecewiseSeries) and isinstance(before, PiecewiseSeries) and mine.agrees(before):
        resolved = resolved.replace(grading=before)
    if isinstance(resolved.law, CustomLaw) and resolved.law.agrees(there.law):
        resolved = resolved.replace(law=there.law)
    return resolved


def check_room(plan: Plan) -> None:
    """Refuse what fits neither the place, nor the memory, nor the disk."""
    if finished(plan) < plan.total:
        refuse_read_only(plan.path)
    for one in plan.reducers:
        one.check()
    there = [plan.path, *plan.folder.glob("shards/block-*.h5")]
    held = sum(file.stat().st_size for file in there if file.is_file())
    needed = sum(one.disk for one in plan.reducers) - held
    free = shutil.disk_usage(plan.path.parent).free
    if needed > free:
        raise StoreError(
            f"{plan.path}: needs up to {gibibytes(needed)} more on the disk while made and {gibibytes(free)} "
            "are free; free some space, choose another -o, or reduce surfaces or separations"
        )


def finished(plan: Plan) -> int:
    """Return the number of surfaces that its file holds, if that is its own; of a sweep all or none."""
    path = plan.path
    if not path.exists():
        return 0
    attributes, there = described(path)
    if attributes.get("run") != plan.identity:
        axes, draws = str(attributes.get("axes", "")), str(attributes.get("draws", "another version"))
        kind = "sweep" if axes else "ensemble"
        raise another(path, kind, (str(attributes["scene"]), axes, draws), plan.question)
    if plan.axes:
        return plan.total
    if there.n_surfaces > plan.total:
        raise StoreError(
            f"{path}: holds {there.n_surfaces} surfaces already, more than ensemble.n_surfaces = "
            f"{plan.total}; ask for as many or more, or choose another -o"
        )
    if there.n_surfaces < plan.total:
        look(path)  # all of it: it is about to be copied
    return there.n_surfaces


def put(plan: Plan, contents: Callable[[], Labelled], go_on: Callable[[], None] | None = None) -> None:
    """Write the file of a plan in one atomic step over what is there, if that is its own. With the lock.

    With `go_on`, of a file of many blocks, it is read back before those go.
    """
    path, before = plan.path, state_of(plan.path)
    finished(plan)
    try:
        with whole_file(path, expected=before, folder=plan.folder) as temporary:
            write(temporary, contents(), plan.of_all, go_on)
            if go_on and (problem := verify(temporary)[0]):
                raise RunError(f"{path}: was not written correctly ({problem}); is the disk failing?")
    except FileExistsError as error:
        raise RunError(
            f"{path}: {error.strerror}; it was not changed, and finished blocks are kept: move that file "
            "away and repeat the command, or choose another -o"
        ) from None
    except RunError:
        raise
    except (OSError, RuntimeError) as error:  # HDF5 tells of a full disk by either
        why = getattr(error, "strerror", None) or error
        raise RunError(
            f"{path}: cannot be written ({why}); is the disk full? Finished blocks are "
            "kept; free some space and repeat the command"
        ) from None


def save(ensemble: Ensemble, path: str | Path) -> Ensemble:
    """Write an ensemble in memory to a file, in one atomic step; never over another one.

    Parameters
    ----------
    ensemble : Ensemble
        With all surfaces of its scene.
    path : str or Path
        The file.

    Returns
    -------
    Ensemble
        That reads from the file.

    Raises
    ------
    StoreError
        If the place cannot be written, another process writes there, or another ensemble, or a run that
        is not finished, has it.
    RunError
        If the disk does not take it.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> e = mcgw.simulate(scene)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     mcgw.save(e, f"{folder}/e.h5").n_surfaces
    20
    """
    check_object("save", ensemble, Ensemble)
    path = Path(path)
    check_output(path)
    with locked(parts_of(path)):
        if (parts_of(path) / RECORD).exists():
            raise StoreError(
                f"{path}: a run that makes this file is not finished; finish it, choose another -o, "
                f"or remove {parts_of(path)}"
            )
        plan = Plan(storable(ensemble.scene), path, ensemble.sampler)
        put(plan, lambda: plan.contents([ensemble.sums], 0.0))
    return open_ensemble(path)


def tidy(path: Path) -> None:
    """Remove what dead processes left of the making of a file; nothing that a command could go on from.

    Nothing is done, and nothing said, where another process works on that file or nothing may be removed.
    """
    remove_stale(path)
    folder = parts_of(path)
    if folder.is_dir() and not folder.is_symlink():
        with suppress(StoreError, OSError), locked(folder, patience=0):
            drop_leftovers(path)


def drop_leftovers(path: Path) -> None:
    """As `tidy`, for who has the lock; a run stays if it has a block that its file does not have."""
    folder, held = parts_of(path), 0
    for left in folder.rglob(".*.tmp"):
        left.unlink(missing_ok=True)
    begun = (folder / RECORD).exists()  # without it nobody knows what the blocks are
    shards = list(folder.glob("shards/block-*.h5")) if begun else []
    if shards and path.exists():
        with suppress(StoreError):  # else a person must look
            plan, (attributes, there) = Plan.open(folder), described(path)
            if attributes.get("run") == plan.identity:
                held = plan.kept(plan.total if plan.axes else there.n_surfaces)
    if not any(int(shard.stem.removeprefix("block-")) >= held for shard in shards):
        remove_run(folder)


def remove_run(folder: Path) -> None:
    """Remove a run, readable or not; its lock stays, and with it the folder. Only with the lock."""
    shutil.rmtree(folder / "shards", ignore_errors=True)  # a worker that lost its driver may add to it
    for left in (*folder.glob(".*.tmp"), folder / RECORD):
        left.unlink(missing_ok=True)
