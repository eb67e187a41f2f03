"""``mcgw.merge``: of several jobs' blocks the file that they are of, a run's or a sweep's."""

from pathlib import Path

from mcgw.ensemble.ensemble import Ensemble
from mcgw.jobs import merging
from mcgw.store.ensembles import filetype_of
from mcgw.sweeps.file import FILETYPE
from mcgw.sweeps.folder import ASKED, folder_of
from mcgw.sweeps.in_file import merge_sweep
from mcgw.sweeps.sweep import Sweep

__all__ = ["merge"]


def merge(path: str | Path) -> Ensemble | Sweep:
    """Make the file of a run or of a sweep whose blocks are all there.

    Parameters
    ----------
    path : str or Path
        The file to be.

    Returns
    -------
    Ensemble or Sweep
        That reads from it.

    Raises
    ------
    StoreError
        If there is no such run.
    RunError
        If blocks are missing, or the disk does not take the file.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> over = {"ensemble.n_asperities": [100, 200]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     missing = [mcgw.run(scene, f"{folder}/demo.h5", shard=f"{i}/2") for i in (1, 2)]
    ...     missing[-1], mcgw.merge(f"{folder}/demo.h5").n_surfaces
    ...     missing = [mcgw.sweep(scene, over, path=f"{folder}/n.h5", shard=f"{i}/2") for i in (1, 2)]
    ...     missing, mcgw.merge(f"{folder}/n.h5").shape
    (0, 20)
    ([20, 0], (2,))
    """
    path = Path(path)
    if path.exists():
        is_sweep = filetype_of(path) == FILETYPE
    else:
        is_sweep = (folder_of(path) / ASKED).is_file()
    return merge_sweep(path) if is_sweep else merging.merge(path)
