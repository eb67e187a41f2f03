"""Ensembles that lie in memory, written to files; the schema stands in `mcgw.store`."""

from pathlib import Path
from typing import Any

import h5py

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import State, check_output, state_of, write_whole
from mcgw.scene.scene_file import scene_text
from mcgw.scene.wrong_object import check_object
from mcgw.store.arithmetic import drawn_with
from mcgw.store.disk import parts_of
from mcgw.store.ensembles import finished, open_ensemble
from mcgw.store.identity import identity_of
from mcgw.store.layout import describe, digest_of, fill, sealed
from mcgw.store.lock import locked
from mcgw.store.shards import DRAWN, Span

__all__ = ["body_of", "save", "write_body"]


def save(ensemble: Ensemble, path: str | Path, *, wall_seconds: float = 0.0) -> Ensemble:
    """Write an ensemble that lies in memory, in one atomic step; never over another one.

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
    ...     mcgw.save(mcgw.regrade(e, mcgw.Exponential(2.0)), f"{folder}/stiffer.h5").n_surfaces
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
        about = {"run": identity_of(*asked), "draws": drawn_with(*asked), "wall_seconds": wall_seconds}
        write_body(path, body_of(ensemble, **about), before)
    return open_ensemble(path)


def write_body(path: Path, body: tuple[bytes, bytes], before: State | None) -> None:
    """Write a file and its trailer in one atomic step, over what `before` says that was there. With the lock.

    Raises
    ------
    StoreError
        If something else has this name by now.
    RunError
        If the disk does not take it.
    """
    try:
        write_whole(path, body, expected=before)
    except FileExistsError as error:
        raise StoreError(f"{path}: {error.strerror}; it is left as it is, choose another -o") from None
    except OSError as error:
        raise RunError(
            f"{path}: cannot be written ({error.strerror or error}); make room and repeat"
        ) from None


def body_of(ensemble: Ensemble, **about: Any) -> tuple[bytes, bytes]:
    """The file of an ensemble, with more attributes, and its trailer."""
    scene = ensemble.scene
    if ensemble.drawn_for is not None:
        about["drawn_for"] = scene_text(ensemble.drawn_for)
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import body_of_statistics  # for those scenes alone

        return body_of_statistics(ensemble, **about)
    names = [*scene.shapes, *(DRAWN if scene.keep == "moments" else ())]
    arrays = {name: ensemble.sums.read(name, 0, None) for name in names}

    def make(file: h5py.File) -> None:
        fill(file, scene, [(Span(0, ensemble.n_surfaces), arrays)])
        describe(file, scene, ensemble.sampler, digest_of(file, scene, [arrays]), **about)

    return sealed(make)
