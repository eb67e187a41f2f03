"""Ensembles in memory, saved to files."""

from pathlib import Path

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import StoreError
from mcgw.formats.files import check_output, state_of
from mcgw.scene.arguments import check_object
from mcgw.store.disk import parts_of
from mcgw.store.ensembles import open_ensemble
from mcgw.store.identity import identity_of, versions
from mcgw.store.lock import locked
from mcgw.store.place import contents_of, finished, put


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
