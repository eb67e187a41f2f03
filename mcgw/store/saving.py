"""A file of results put in its place: written under another name, read back, renamed."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import State, check_output, state_of, whole_file
from mcgw.scene.arguments import check_object
from mcgw.store.disk import parts_of
from mcgw.store.ensembles import open_ensemble, verify
from mcgw.store.h5_file import Contents, write
from mcgw.store.identity import identity_of, versions
from mcgw.store.layout import contents_of_values
from mcgw.store.lock import locked
from mcgw.store.place import finished


def contents_of(ensemble: Ensemble, **about: Any) -> Contents:
    """Those of the file of an ensemble in memory, with more attributes."""
    scene, sums = ensemble.scene, ensemble.sums
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import contents_of_statistics  # for those scenes alone

        return contents_of_statistics(ensemble, **about)
    return contents_of_values(scene, ensemble.sampler, partial(sums.read, start=0, stop=None), **about)


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
        if (parts_of(path) / "run.toml").exists():
            raise StoreError(
                f"{path}: a run that makes this file is not finished; finish it, choose another -o, "
                f"or remove {parts_of(path)}"
            )
        before, asked = state_of(path), (ensemble.scene, ensemble.sampler)
        finished(path, *asked)
        about = {"run": identity_of(*asked), "draws": versions(of_draws=True), "wall_seconds": wall_seconds}
        put(path, contents_of(ensemble, **about), before)
    return open_ensemble(path)
