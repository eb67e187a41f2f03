"""What lies at the place of a file: surfaces, a seed, what the dead left behind; and a new file."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import State, check_output, remove_stale, state_of, whole_file
from mcgw.scene.arguments import check_object
from mcgw.scene.fields import LeftOut
from mcgw.scene.scene import Scene, storable
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.store.ensembles import described, open_ensemble, read_attributes, verify
from mcgw.store.h5_reading import look
from mcgw.store.h5_writing import Contents, write
from mcgw.store.identity import Written, difference, versions
from mcgw.store.layout import contents_of
from mcgw.store.lock import locked, parts_of
from mcgw.store.run_folder import RECORD, RunFolder, remove_run


def recorded_scene(path: Path) -> Scene | None:
    """Scene of the ensemble or run that is at a place, if there is one."""
    if path.is_file():
        return described(path)[1]
    return RunFolder.open(parts_of(path)).scene if (parts_of(path) / RECORD).is_file() else None


def with_recorded_seed(scene: Scene, path: Path) -> Scene:
    """Return the scene; with the seed of what lies there, if nobody gave it one."""
    there = recorded_scene(path) if isinstance(scene.seed, LeftOut) else None
    return scene if there is None else scene.replace(seed=LeftOut(there.seed))


def finished(path: Path, wanted: Written) -> int:
    """Return the number of surfaces that a file holds of a scene; 0 if there is no file.

    Raises
    ------
    StoreError
        If the file is damaged, holds another ensemble, or more surfaces than asked for.
    """
    if not path.exists():
        return 0
    attributes, there = described(path)
    if "axes" in attributes:
        raise StoreError(f"{path}: holds a sweep; choose another -o, or remove it")
    if attributes.get("run") != wanted.identity:
        before = scene_text(there), "", str(attributes.get("draws", "another version"))
        what = difference(before, (wanted.text, "", versions(of_draws=True)))
        raise StoreError(f"{path}: holds a different ensemble: {what}; choose another -o, or remove it")
    asked = wanted.scene.n_surfaces
    if there.n_surfaces > asked:
        raise StoreError(
            f"{path}: holds {there.n_surfaces} surfaces already, more than ensemble.n_surfaces = {asked}; "
            "ask for as many or more, or choose another -o"
        )
    if there.n_surfaces < asked:
        look(path)  # all of it: it is about to be copied
    return there.n_surfaces


def put(
    path: Path, contents: Contents, before: State | None, go_on: Callable[[], None] | None = None
) -> None:
    """Write a file in one atomic step over what `before` says that was there. With the lock.

    With `go_on`, of a file of many blocks, it is read back before those go.

    Raises
    ------
    RunError
        If something else has this name by now, or the disk does not take it.
    """
    try:
        with whole_file(path, expected=before, folder=parts_of(path)) as temporary:
            write(temporary, contents, go_on)
            if go_on and (problem := verify(temporary)[0]):
                raise RunError(f"{path}: was not written correctly ({problem}); is the disk failing?")
    except FileExistsError as error:
        raise RunError(
            f"{path}: {error.strerror}; it was not changed, and finished blocks are kept: move that file "
            "away and repeat the command, or choose another -o"
        ) from None
    except (OSError, RuntimeError) as error:
        if isinstance(error, RunError):
            raise
        said = error.strerror if isinstance(error, OSError) else None
        why = said or next(iter(str(error).splitlines()), type(error).__name__)
        raise RunError(
            f"{path}: cannot be written ({why}); is the disk full? Finished blocks are kept; free some space "
            "and repeat the command"
        ) from None


def save(ensemble: Ensemble, path: str | Path, *, wall_seconds: float = 0.0) -> Ensemble:
    """Write an ensemble in memory to a file, in one atomic step; never over another one.

    Parameters
    ----------
    ensemble : Ensemble
        With all surfaces of its scene.
    path : str or Path
        The file.
    wall_seconds : float, optional
        What making it took.

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
        before, written = state_of(path), Written.of(storable(ensemble.scene), ensemble.sampler)
        finished(path, written)
        about = {"run": written.identity, "draws": versions(of_draws=True), "wall_seconds": wall_seconds}
        put(path, contents_of(ensemble, written, **about), before)
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
    """As `tidy`, for who has the lock."""
    folder = parts_of(path)
    for left in (*folder.glob(".*.tmp"), *(folder / "shards").glob(".*.tmp")):
        left.unlink(missing_ok=True)
    if not _of_use(path):
        remove_run(folder)


def _of_use(path: Path) -> bool:
    """Whether a run has a block that its file does not have."""
    folder = parts_of(path)
    begun = (folder / RECORD).exists()  # without it nobody knows what the blocks are
    shards = list((folder / "shards").glob("block-*.h5")) if begun else []
    if not shards or not path.exists():
        return bool(shards)
    try:
        run, attributes = RunFolder.open(folder), read_attributes(path)
        same = attributes.get("run") == run.identity
        here = run.plan.total if run.axes else scene_from(attributes["scene"]).n_surfaces
        held = run.plan.kept(here) if same else 0
    except StoreError:
        return True  # a person must look
    return any(int(shard.stem.removeprefix("block-")) >= held for shard in shards)
