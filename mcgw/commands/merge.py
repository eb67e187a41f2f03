"""``mcgw merge``: join the blocks drawn by jobs into one file."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import file_out
from mcgw.commands.outputs import HDF5
from mcgw.commands.voice import news


def merge(file: Annotated[Path, file_out(HDF5, grows=True)]) -> None:
    """Merge the blocks of a run or sweep that several jobs drew (--shard i/n) into one file.

    Parameters
    ----------
    file : FILE
        the file to make, as given to run -o

    Examples
    --------
    mcgw merge demo.h5
    """
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.formats.files import state_of
    from mcgw.jobs.making import merge as merged

    before = state_of(file)
    found = merged(file)
    done = "was finished before, " if state_of(file) == before else ""
    if isinstance(found, Ensemble):
        scene, made = found.scene, f"{found.n_surfaces} surfaces"
    else:
        scene, made = found.scenes[0], f"{found.axes.size} scenes"
    news(f"{file}: {done}{made}, seed {scene.seed}", f"next: mcgw compare {file}")
