"""Shards: the results of some consecutive surfaces, each a file of its own that is there whole or not.

Its attributes are the identity of the run, the numbers of the surfaces, and how long these took.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mcgw.ensemble.labelled import Variable
from mcgw.ensemble.results import BLOCK, Tables
from mcgw.errors import StoreError
from mcgw.formats.files import whole_file
from mcgw.store.h5_file import BLOCK_TYPE, FORMAT, Contents, look, read_tables, write
from mcgw.store.spans import Span


@dataclass(frozen=True)
class Shard:
    """A shard that was looked at.

    Parameters
    ----------
    path : Path
        Where it lies.
    span : Span
        Its surfaces.
    seconds : float
        What drawing it took.
    """

    path: Path
    span: Span
    seconds: float

    def tables(self, *wanted: str) -> Tables:
        """Its tables, all or some, read and compared with their checksums.

        Raises
        ------
        StoreError
            If it was damaged or removed since.
        """
        if not self.path.exists():
            raise StoreError(f"{self.path}: no longer exists; its run has ended, open the file again")
        return read_tables(self.path, wanted or None)


def commit_shard(path: Path, run: str, span: Span, tables: Tables, seconds: float) -> Shard:
    """Write a shard of a run in one atomic step, with the seconds that drawing it took.

    Raises
    ------
    StoreError
        If a number is not finite: nothing is written.
    OSError
        If the disk does not take it.
    """
    for name, values in tables.items():
        if len(values) != (1 if name.startswith(BLOCK) else span.n):
            raise StoreError(f"{path}: {name} does not have the rows of {span}")
        if not np.all(np.isfinite(values)):
            raise StoreError(f"{path}: {name} holds numbers that are not finite")
    about = {"filetype": BLOCK_TYPE, "format": FORMAT, "run": run, "first": span.first, "n": span.n}
    variables = {name: Variable((), values, "", "") for name, values in tables.items()}
    with whole_file(path) as temporary:
        write(temporary, Contents(variables, {**about, "wall_seconds": seconds}))
    return Shard(path, span, seconds)


def open_shard(path: Path, run: str, *, numbers: bool = True) -> Shard:
    """A shard of this run; its numbers are compared with their checksums unless that is left out.

    Raises
    ------
    StoreError
        If it is not there, damaged, or belongs elsewhere.
    """
    said = look(path, BLOCK_TYPE, numbers=numbers).attributes
    if said["run"] != run:
        raise StoreError(f"{path}: belongs to another run")
    shard = Shard(path, Span(said["first"], said["n"]), said["wall_seconds"])
    if path.name != shard.span.file_name:
        raise StoreError(f"{path}: holds {shard.span}, unlike its name")
    return shard
